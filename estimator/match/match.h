// Matching of observed digs to the table, by the Euclidean norm of the moment over the path, as in
// the paper. dig_match_nearest() is exact over all entries; dig_fit_refine() (fit_nlopt.c) refines
// between the grid points with NLopt. Both run off the real-time thread.

#ifndef DIG_ESTIMATOR_MATCH_MATCH_H
#define DIG_ESTIMATOR_MATCH_MATCH_H

#include "core/curve.h"
#include "core/gravel_match.h"
#include "core/observation.h"
#include "estimator/match/rubbed.h"

#include <math.h>

/// Distance of digs from a curve of the table, less what friction of the drives explains of it
/// (rubbed.h), and what noise alone would make it; both relative to the norm of the measurement.
struct dig_distance {
    double distance, noise_floor;
};

/// The same as sums of squares over points and digs.
struct dig_misfit {
    double            miss2_Nm2, floor2_Nm2, norm2_Nm2;
    struct dig_rubbed rubbed; // of misses, and what friction adds, Nm
};

void dig_misfit_add(struct dig_misfit *sum, const struct dig_misfit *more);

struct dig_distance dig_misfit_distance(const struct dig_misfit *sum);

struct dig_cell;   // estimator/approach/interpolate.h
struct dig_pooled; // estimator/match/pool.h

/// Misfit over the points measured, summed over single digs: pooling changes distance and floor by
/// chance only.
struct dig_misfit dig_cell_misfit(const struct dig_cell *cell, const struct dig_pooled *group);

/// DIG_EINVAL: one is not finite, 0 everywhere, of a range outside 0 … 1, or of a trajectory the
/// set lacks.
DIG_MUST_CHECK enum dig_status dig_observations_check(const struct dig_curve_set *set, size_t digs,
                                                      const struct dig_observation dig[]);

/// Interpolates the table's curves of one trajectory at gravel: multilinear in friction, rolling
/// friction and log density within the grid cell around it. DIG_ENOMATCH when the gravel is outside
/// the grid or a corner of its cell that has any weight is missing.
DIG_MUST_CHECK enum dig_status dig_match_interpolate(const struct dig_curve_set *set,
                                                     const struct dig_gravel    *gravel,
                                                     size_t trajectory, struct dig_curve *curve);

/// The entry nearest to digs of one ground (1 or more, youngest last): least root mean square of
/// their distances. Sets gravel, mean, low and high to that entry's, and the noise floor, of one
/// dig about a mean of few and of the measurement:
///
///   sqrt(sum (sd^2 (1 + 1/packings) + sigma^2)) / ||measured||
///
/// An entry that lacks a trajectory that was dug is skipped. DIG_ENOMATCH: every entry lacks one.
/// DIG_EINVAL: an observation fails dig_observations_check(). O(entries), but few curves are
/// compared in full (estimator/match/nearest.h); 270 kB of stack.
DIG_MUST_CHECK enum dig_status dig_match_nearest(const struct dig_curve_set *set, size_t digs,
                                                 const struct dig_observation dig[],
                                                 double outside_floors, struct dig_match *match);

/// Finds the entry nearest by the noise-weighted distance (estimator/match/weighted.c), the first
/// of several that are equal, over every channel that all digs measured; of a valid match of these
/// digs, whose nearest entry has all trajectories that were dug. Sets weighted, and
/// weighted_distance, of which 1 is expected of digs of the entry's gravel; -1 and NaN: nothing can
/// be compared. O(entries), some 0.05 microseconds each; 350 kB of stack.
void dig_match_find_weighted(const struct dig_curve_set *set, size_t digs,
                             const struct dig_observation dig[], struct dig_match *match);

/// An axis is undetermined ("untold" in messages) where its 90 % interval is wider than this share
/// of the table's axis (of density, of its logarithm): the digs do not say which half of it.
/// Without any information the interval is nine tenths of the axis.
#define DIG_MATCH_TOLD 0.5

/// Sets untold of a match that has low and high. False for an axis of one point, and for all of a
/// match that was not refined.
void dig_match_find_family(const struct dig_curve_set *set, struct dig_match *match);

/// True when an axis is undetermined: the samples are a family of gravels that resist alike, and
/// `gravel` is only one of them.
bool dig_match_is_family(const struct dig_match *match);

/// The undetermined axes, "rolling, density_kgpm3"; "" when none.
#define DIG_UNTOLD_SIZE 48
void dig_match_unresolved(const struct dig_match *match, char text[DIG_UNTOLD_SIZE]);

/// Refines a nearest match of these digs between the grid points, and computes the posterior of the
/// gravel (low and high are widened to hold the gravel). Decides again by the smallest distance
/// whether the gravel is outside the table; where every dig has forces, also by their excess over
/// the most probable gravel (DIG_POSTERIOR_OUTSIDE), and the gravel is then that of the moment
/// alone. DIG_EINVAL: no valid match of these digs, or max_evaluations < 1; DIG_ENOMEM. *match is
/// unchanged then. Allocates (in NLopt): never in the tick. Some ten milliseconds; 500 kB of stack.
DIG_MUST_CHECK enum dig_status dig_fit_refine(const struct dig_curve_set *set, size_t digs,
                                              const struct dig_observation dig[],
                                              int max_evaluations, struct dig_match *match);

/// The curve predicted for one trajectory at the match, rig scale: mean and 1 sigma of one dig, the
/// spread between packings and the uncertainty of the gravel taken together. A match that was not
/// refined predicts for its gravel alone. DIG_EINVAL: no valid match or no such trajectory;
/// DIG_ENOMATCH: the table lacks that trajectory there.
DIG_MUST_CHECK enum dig_status dig_predict_curve(const struct dig_curve_set *set,
                                                 const struct dig_match *match, size_t trajectory,
                                                 struct dig_curve *curve);

#endif // DIG_ESTIMATOR_MATCH_MATCH_H
