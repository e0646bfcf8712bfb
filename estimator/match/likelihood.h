// Likelihood of digs along one trajectory given a gravel, by the formula of posterior.h: point by
// point, or approximately by the outlines of a prefilter, at an eighth of the work.

#ifndef DIG_ESTIMATOR_MATCH_LIKELIHOOD_H
#define DIG_ESTIMATOR_MATCH_LIKELIHOOD_H

#include "core/curve.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/gaussian.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"

/// The part that does not depend on the gravel; 22 kB.
struct dig_likelihood {
    bool                is_gaussian; // by block means and the packings' covariance
    struct dig_gaussian gaussian;

    const struct dig_prefilter *rough; // NULL: point by point
    size_t                      trajectory;
    size_t                      channels;  // the moment alone, or the forces too
    double                      effective; // independent errors along the dig
    double                      relative2[DIG_FORCE_CHANNELS]; // pooled (sd / mean)^2
    size_t                      count;                         // of points, or of blocks
    double                      measured_count;
    // Of each: 1 and 1 / digs where it was measured, 0 where not; what was; its sigma^2.
    double measured[DIG_CURVE_POINTS];
    double inverse_digs[DIG_CURVE_POINTS];
    double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double sigma2[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

/// Without a prefilter (NULL) it reads every curve of the trajectory: O(entries).
void dig_likelihood_make(const struct dig_curve_set *set, const struct dig_prefilter *prefilter,
                         const struct dig_pooled *group, struct dig_likelihood *likelihood);

/// Makes it approximate, by the blocks that were measured completely. The prefilter must outlive
/// it. False, and unchanged, when these are less than half of what was measured.
bool dig_likelihood_outline(const struct dig_prefilter *prefilter,
                            struct dig_likelihood      *likelihood);

/// Its logarithm at a cell of the trajectory (dig_cell_find), up to a constant. 4 microseconds,
/// with forces 11.
double dig_likelihood_log(const struct dig_likelihood *likelihood, const struct dig_cell *cell);

/// Reduced chi-squared: mean over points and channels of (m - t)' D^-1 (m - t), 1 expected for digs
/// in the cell's gravel. The same cost.
double dig_likelihood_reduced_chi2(const struct dig_likelihood *likelihood,
                                   const struct dig_cell       *cell);

#endif // DIG_ESTIMATOR_MATCH_LIKELIHOOD_H
