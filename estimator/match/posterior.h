// Posterior of the gravel given one dig or several of one ground, on a fine grid over the
// interpolated table.
//
// Uniform prior over friction, rolling friction and log density within the table's complete cells;
// the likelihood is that of gaussian.h. Trajectories are independent: their logarithms add.

#ifndef DIG_ESTIMATOR_MATCH_POSTERIOR_H
#define DIG_ESTIMATOR_MATCH_POSTERIOR_H

#include "core/curve.h"
#include "core/gravel_match.h"
#include "estimator/match/pool.h"

/// Excess of digs with forces over the most probable gravel beyond which the gravel is outside the
/// table. Of 255 digs along simpleA, left out of their own gravel's entry, none exceeds it
/// (tables/reference_rig.sqlite; tests/bench/outside.c).
#define DIG_POSTERIOR_OUTSIDE 3.0

/// Excess of the digs' distance from a gravel over what their errors make it, in standard
/// deviations of that: of a chi-square q of so many numbers as are compared (gaussian.h, summed
/// over the trajectories) as a normal one,
///
///   excess = ((q / numbers)^(1/3) - (1 - r)) / sqrt(r),   r = 2 / (9 numbers)
///
/// (Wilson & Hilferty 1931). Infinite where the table has no curve, 0 where nothing is compared.
/// Some 30 microseconds a trajectory.
double dig_posterior_excess(const struct dig_curve_set *set, const struct dig_pool_sums *sums,
                            const struct dig_gravel *gravel);

/// Fills mean, mode, low, high and the samples of *match. DIG_ENOMATCH when the table has no
/// complete cell for the trajectories that were dug; then *match is unchanged. About 8000
/// evaluations a trajectory. 120 kB of stack.
DIG_MUST_CHECK enum dig_status dig_posterior_fill(const struct dig_curve_set *set,
                                                  const struct dig_pool_sums *sums,
                                                  struct dig_match           *match);

#endif // DIG_ESTIMATOR_MATCH_POSTERIOR_H
