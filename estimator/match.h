// Which gravel of the table resists like the one measured: Euclidean norm over the path, as the
// paper has it. dig_match_nearest() is exact over all entries; dig_fit_refine() (fit_nlopt.c) goes
// on between the grid points with NLopt. Both run off the real-time thread.

#ifndef DIG_ESTIMATOR_MATCH_H
#define DIG_ESTIMATOR_MATCH_H

#include "core/curve.h"
#include "estimator/estimator.h"

/// Distance of a curve of the table from an observation, and what the noise alone would make it.
struct dig_distance {
    double distance, noise_floor;
};

struct dig_cell; // estimator/interpolate.h

/// Over the points measured. The observation must have passed its check.
struct dig_distance dig_cell_distance(const struct dig_cell        *cell,
                                      const struct dig_observation *observation);

/// DIG_EINVAL: not finite, 0 everywhere, a range outside 0 … 1, or a trajectory the set lacks.
DIG_MUST_CHECK enum dig_status dig_observation_check(const struct dig_curve_set   *set,
                                                     const struct dig_observation *observation);

/// Interpolates the table's curves of one trajectory at gravel: multilinear in friction, rolling
/// friction and log density within the grid cell around it. DIG_ENOMATCH when the gravel is outside
/// the grid or a corner of its cell that has any weight is missing.
DIG_MUST_CHECK enum dig_status dig_match_interpolate(const struct dig_curve_set *set,
                                                     const struct dig_gravel    *gravel,
                                                     size_t trajectory, struct dig_curve *curve);

/// Nearest entry. gravel, mean, low and high are that entry's; noise_floor is
/// sqrt(sum (sd^2 (1 + 1/packings) + sigma^2)) / ||measured||: one dig about a mean of few, and the
/// measurement. DIG_ENOMATCH: no entry has the observation's trajectory. DIG_EINVAL: an observation
/// that is not finite, is 0 everywhere, or of no trajectory of the set. O(entries).
DIG_MUST_CHECK enum dig_status dig_match_nearest(const struct dig_curve_set   *set,
                                                 const struct dig_observation *observation,
                                                 double outside_floors, struct dig_match *match);

/// From a nearest match on between the grid points, and the posterior of the gravel (low and high
/// widened where needed to hold the gravel of the smallest distance); judges again whether the
/// gravel is outside the table. Allocates (in NLopt); never call it in the tick. At most
/// max_evaluations of the distance, then the posterior on a fixed grid: some ten milliseconds and
/// 200 kB of stack. DIG_EINVAL: no valid match of this observation, or max_evaluations < 1;
/// DIG_ENOMEM. Then *match is unchanged.
DIG_MUST_CHECK enum dig_status dig_fit_refine(const struct dig_curve_set   *set,
                                              const struct dig_observation *observation,
                                              int max_evaluations, struct dig_match *match);

/// The curve predicted for one trajectory at the match, rig scale: mean and 1 sigma of one dig, the
/// spread between packings and the uncertainty of the gravel taken together. A match that was not
/// refined predicts for its gravel alone. DIG_EINVAL: no valid match or no such trajectory;
/// DIG_ENOMATCH: the table lacks that trajectory there.
DIG_MUST_CHECK enum dig_status dig_predict_curve(const struct dig_curve_set *set,
                                                 const struct dig_match *match, size_t trajectory,
                                                 struct dig_curve *curve);

#endif // DIG_ESTIMATOR_MATCH_H
