// Which gravel of the table resists like the one measured: Euclidean norm over the path, as the
// paper has it. dig_match_nearest() is exact over all entries; dig_fit_refine() (fit_nlopt.c) goes on
// between the grid points with NLopt. Both run off the real-time thread.

#ifndef DIG_ESTIMATOR_MATCH_H
#define DIG_ESTIMATOR_MATCH_H

#include "core/curve.h"
#include "estimator/estimator.h"

/// Interpolates the table's curves of one trajectory at gravel: multilinear in friction, rolling
/// friction and log density within the grid cell around it. DIG_ENOMATCH when the gravel is outside
/// the grid or a corner of its cell is missing.
DIG_MUST_CHECK enum dig_status dig_match_interpolate(const struct dig_curve_set *set,
                                                     const struct dig_gravel *gravel,
                                                     size_t trajectory, struct dig_curve *curve);

/// Nearest entry. DIG_ENOMATCH: no entry has the observation's trajectory.
DIG_MUST_CHECK enum dig_status dig_match_nearest(const struct dig_curve_set *set,
                                                 const struct dig_observation *observation,
                                                 double outside_floors, struct dig_match *match);

/// From a nearest match on between the grid points, and the posterior of the gravel. Allocates (in
/// NLopt); never call it in the tick. At most max_evaluations of the distance.
DIG_MUST_CHECK enum dig_status dig_fit_refine(const struct dig_curve_set *set,
                                              const struct dig_observation *observation,
                                              int max_evaluations, struct dig_match *match);

/// The curve predicted for one trajectory at the match, rig scale: mean and 1 sigma of one dig, the
/// spread between packings and the uncertainty of the gravel taken together.
DIG_MUST_CHECK enum dig_status dig_predict_curve(const struct dig_curve_set *set,
                                                 const struct dig_match *match, size_t trajectory,
                                                 struct dig_curve *curve);

#endif // DIG_ESTIMATOR_MATCH_H
