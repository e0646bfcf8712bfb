// How sure the matcher is: the posterior of the gravel given one dig, on a fine grid over the
// interpolated table.
//
// Uniform prior over friction, rolling friction and log density within the table's complete cells.
// Errors along a dig are not independent: a packing that resists more does so for about a bucket's
// quarter of path. So the mean of the squared normalised errors counts n_eff times, not 256:
//
//   log L = -n_eff / 2 * mean over points ( (m - t)^2 / D + log D ),   n_eff = path / correlation
//
// D: variance of one dig about a mean of few packings, drawn towards the table's pooled spread as a
// standard deviation of three packings is itself uncertain, plus the measurement's sigma^2.

#ifndef DIG_ESTIMATOR_POSTERIOR_H
#define DIG_ESTIMATOR_POSTERIOR_H

#include "core/curve.h"
#include "estimator/estimator.h"

/// Path over which errors of a dig are correlated (equivalent width), in bucket lengths. Measured
/// on 26 LIGGGHTS digs of three gravels over 4 to 5 packings: autocorrelation of the normalised
/// residuals falls to one half after 0.05 to 0.11 tooth lengths and to nothing after 0.2 to 0.25.
#define DIG_POSTERIOR_CORRELATION 0.25

/// Fills mean, low, high and the samples of *match. DIG_ENOMATCH when the table has no complete
/// cell for the observation's trajectory; then *match is unchanged. The observation must have
/// passed dig_observation_check(). About 8000 evaluations; 130 kB of stack.
DIG_MUST_CHECK enum dig_status dig_posterior_fill(const struct dig_curve_set   *set,
                                                  const struct dig_observation *observation,
                                                  struct dig_match             *match);

#endif // DIG_ESTIMATOR_POSTERIOR_H
