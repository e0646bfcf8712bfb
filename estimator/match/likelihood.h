// Likelihood of digs along one trajectory given a gravel, point by point: it sees where along the
// path the bucket meets the ground, which block means (gaussian.h) blur.
//
// Errors along a dig are correlated over about a quarter of a bucket length. So the mean of the
// squared normalised errors counts n_eff times, not 256:
//
//   log L = -n_eff / 2 * mean over points ( (m - t)' D^-1 (m - t) + log det D ),
//   n_eff = path / correlation
//
// m: mean of the n digs along a trajectory, moment or (My, Fx, Fz). D: its covariance about the
// table's mean of few packings N, of variances
//
//   spread^2 (1/n + 1/N) + sigma^2 / n
//
// and the correlations between channels of entry_scatter.h times the first part. What friction of
// the drives adds is one number a drive for all points (rubbed.h), and none of sigma. spread: of
// one dig, shrunk towards the table's pooled spread, as a standard deviation of three packings is
// uncertain; sigma: of one measurement.

#ifndef DIG_ESTIMATOR_MATCH_LIKELIHOOD_H
#define DIG_ESTIMATOR_MATCH_LIKELIHOOD_H

#include "core/curve.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/pool.h"

#include <stdbool.h>

/// Path over which errors of a dig are correlated (equivalent width), in bucket lengths. Measured
/// on 26 LIGGGHTS digs of three gravels over 4 to 5 packings: autocorrelation of the normalised
/// residuals falls to one half after 0.05 to 0.11 tooth lengths and to nothing after 0.2 to 0.25.
#define DIG_LIKELIHOOD_CORRELATION 0.25

/// The part that does not depend on the gravel.
struct dig_likelihood {
    const struct dig_pooled *group;
    size_t                   channels;                      // the moment alone, or the forces too
    bool                     rubbed;                        // by drives whose friction is not known
    double                   effective;                     // independent errors along the dig
    double                   relative2[DIG_FORCE_CHANNELS]; // pooled (sd / mean)^2
    double                   measured_count;                // points
};

/// The group must outlive it.
void dig_likelihood_make(const struct dig_curve_set *set, const struct dig_pooled *group,
                         struct dig_likelihood *likelihood);

/// Its logarithm at a cell of the trajectory (dig_cell_find), up to a constant. 4 microseconds,
/// with forces 12, with friction 25.
double dig_likelihood_log(const struct dig_likelihood *likelihood, const struct dig_cell *cell);

/// Logarithm of the mean likelihood of the digs over the gravels of the table, evenly on friction,
/// rolling friction and log density, on a coarse grid; -INFINITY where the table has no complete
/// cell. Some 600 evaluations.
double dig_likelihood_evidence(const struct dig_curve_set *set, const struct dig_pooled *group);

#endif // DIG_ESTIMATOR_MATCH_LIKELIHOOD_H
