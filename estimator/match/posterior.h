// How sure the matcher is: the posterior of the gravel given one dig or several of one ground, on a
// fine grid over the interpolated table.
//
// Uniform prior over friction, rolling friction and log density within the table's complete cells.
// Errors along a dig are not independent: a packing that resists more does so for about a bucket's
// quarter of path. So the mean of the squared normalised errors counts n_eff times, not 256:
//
//   log L = -n_eff / 2 * mean over points ( (m - t)^2 / D + log D ),   n_eff = path / correlation
//
// m: mean of the n digs along a trajectory. D: its variance about the table's mean of few packings
// N,
//
//   D = spread^2 (1/n + 1/N) + sigma^2 / n
//
// spread: of one dig, drawn towards the table's pooled spread as a standard deviation of three
// packings is itself uncertain; sigma: of one measurement. Digs average their own part down, the
// table's error is common to all. How the digs scatter about their mean is not used: it would tell
// gravels apart by their spreads, which the table knows too badly for that. Trajectories are
// independent: their logarithms add.
//
// Where every dig along a trajectory measured the forces too, m, t are vectors (My, Fx, Fz) and D
// is the matrix of their three spreads with the correlation that packings show, plus sigmas^2 / n:
// (m - t)' D^-1 (m - t) + log det D in place of the above. A gravel that resists alike may push
// otherwise.

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
/// each of three gravels and three trajectories (tables/rig.sqlite;
/// tests/estimator/test_posterior.c).
#define DIG_POSTERIOR_MY_FX (-0.93)
#define DIG_POSTERIOR_MY_FZ 0.63
#define DIG_POSTERIOR_FX_FZ (-0.49)

/// What the logarithm of a likelihood by the packings' covariance (gaussian.h) counts: neither that
/// covariance nor the curves between a table's points are known as well as it takes them to be.
#define DIG_POSTERIOR_TRUST 0.7

/// Digs of moment and forces farther than this from the most probable gravel are of none of the
/// table's. Of 255 digs along simpleA, left out of their own gravel's entry, none is called so
/// (tables/rig.sqlite; tests/bench/outside.c).
#define DIG_POSTERIOR_OUTSIDE 3.0

/// How much farther digs are from a gravel, over all channels measured, than their errors make
/// digs, in standard deviations of that: with the mean of squares normalised over points and
/// channels, which is 1 where the gravel is theirs, and as many independent errors as the
/// likelihood counts,
///
///   excess = (mean - 1) sqrt(channels n_eff / 2)
///
/// Infinite where the table has no curve. By a summary (or NULL) as below; some 15 microseconds a
/// trajectory with it.
double dig_posterior_excess(const struct dig_curve_set *set, const struct dig_prefilter *prefilter,
                            const struct dig_pool_sums *sums, const struct dig_gravel *gravel);

/// Fills mean, mode, low, high and the samples of *match. DIG_ENOMATCH when the table has no
/// complete cell for the trajectories that were dug; then *match is unchanged. About 8000
/// evaluations a trajectory; 220 kB of stack. By a summary of the set only those are made that do
/// not look hopeless by its outlines; without one (NULL) every curve is looked at once more.
DIG_MUST_CHECK enum dig_status dig_posterior_fill(const struct dig_curve_set *set,
                                                  const struct dig_prefilter *prefilter,
                                                  const struct dig_pool_sums *sums,
                                                  struct dig_match           *match);

#endif // DIG_ESTIMATOR_MATCH_POSTERIOR_H
