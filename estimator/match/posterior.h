// Posterior of the gravel given one dig or several of one ground, on a fine grid over the
// interpolated table.
//
// Uniform prior over friction, rolling friction and log density within the table's complete cells.
// Errors along a dig are correlated over about a quarter of a bucket length. So the mean of the
// squared normalised errors counts n_eff times, not 256:
//
//   log L = -n_eff / 2 * mean over points ( (m - t)^2 / D + log D ),   n_eff = path / correlation
//
// m: mean of the n digs along a trajectory. D: its variance about the table's mean of few packings
// N,
//
//   D = spread^2 (1/n + 1/N) + sigma^2 / n
//
// spread: of one dig, shrunk towards the table's pooled spread, as a standard deviation of three
// packings is uncertain; sigma: of one measurement. The part of the digs averages down, the table's
// error is common to all. The scatter of digs about their mean is not used: it would discriminate
// gravels by their spreads, which the table estimates too poorly. Trajectories are independent:
// their logarithms add.
//
// Where every dig along a trajectory measured the forces too, m, t are vectors (My, Fx, Fz) and D
// is the matrix of their three spreads with the correlation that packings show, plus sigmas^2 / n:
// (m - t)' D^-1 (m - t) + log det D in place of the above. Gravels of equal moment may differ in
// force.

#ifndef DIG_ESTIMATOR_MATCH_POSTERIOR_H
#define DIG_ESTIMATOR_MATCH_POSTERIOR_H

#include "core/curve.h"
#include "estimator/match/gravel_match.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"

/// Path over which errors of a dig are correlated (equivalent width), in bucket lengths. Measured
/// on 26 LIGGGHTS digs of three gravels over 4 to 5 packings: autocorrelation of the normalised
/// residuals falls to one half after 0.05 to 0.11 tooth lengths and to nothing after 0.2 to 0.25.
#define DIG_POSTERIOR_CORRELATION 0.25

/// Correlation of the errors of moment and forces of one dig, point by point: over ten packings
/// each of three gravels and three trajectories (tables/reference_rig.sqlite;
/// tests/estimator/test_force_correlation.c).
#define DIG_POSTERIOR_MY_FX (-0.93)
#define DIG_POSTERIOR_MY_FZ 0.63
#define DIG_POSTERIOR_FX_FZ (-0.49)

/// Weight of the logarithm of a likelihood by the packings' covariance (gaussian.h): that
/// covariance and the curves between the table's points are less certain than it assumes.
#define DIG_POSTERIOR_TRUST 0.7

/// Excess of digs with forces over the most probable gravel beyond which the gravel is outside the
/// table. Of 255 digs along simpleA, left out of their own gravel's entry, none exceeds it
/// (tables/reference_rig.sqlite; tests/bench/outside.c).
#define DIG_POSTERIOR_OUTSIDE 3.0

/// Excess of the digs' distance from a gravel over what their errors make it, in standard
/// deviations: with the reduced chi-squared over all channels measured, and as many independent
/// errors as the likelihood counts,
///
///   excess = (chi2 - 1) sqrt(channels n_eff / 2)
///
/// Infinite where the table has no curve. With a prefilter some 15
/// microseconds a trajectory; NULL is allowed.
double dig_posterior_excess(const struct dig_curve_set *set, const struct dig_prefilter *prefilter,
                            const struct dig_pool_sums *sums, const struct dig_gravel *gravel);

/// Logarithm of the digs' mean likelihood over the prior, on a coarse grid, up to a constant;
/// -INFINITY where the table has no complete cell. Some 600 evaluations a trajectory.
double dig_posterior_evidence(const struct dig_curve_set *set, const struct dig_pool_sums *sums);

/// Fills mean, mode, low, high and the samples of *match. DIG_ENOMATCH when the table has no
/// complete cell for the trajectories that were dug; then *match is unchanged. About 8000
/// evaluations a trajectory; 220 kB of stack. A prefilter of the set skips those whose outlines are
/// hopeless; without one (NULL) every curve is read once more.
DIG_MUST_CHECK enum dig_status dig_posterior_fill(const struct dig_curve_set *set,
                                                  const struct dig_prefilter *prefilter,
                                                  const struct dig_pool_sums *sums,
                                                  struct dig_match           *match);

#endif // DIG_ESTIMATOR_MATCH_POSTERIOR_H
