// A way the digs of a campaign may have come about - a gravel, and effects of the soil or none -
// and how well it explains them, everything refitted together.

#ifndef DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H
#define DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H

#include "closed_loop/fit/common_error.h"
#include "closed_loop/fit/forward.h"
#include "closed_loop/fit/steps.h"

struct dig_fitted {
    struct dig_hypothesis hypothesis;
    double                number[DIG_HYPOTHESIS_NUMBERS]; // place; u and contrast of each effect
    double                low[DIG_HYPOTHESIS_NUMBERS];    // 90 % interval: posterior.h fills it
    double                high[DIG_HYPOTHESIS_NUMBERS];
    double                noise[DIG_TRAJECTORY_MAX]; // of a group's mean beyond 1/n, by group
    double                misfit;                    // closed_loop/fit/likelihood.h
    double                squares;                   // of it, what is not a logarithm
    double                means;                     // of that, the means' and z's
    double                z[DIG_STEPS_MAX];          // of the batch's steps
};

/// Where to start a fit from: the numbers given, or those and four corners of the table as well.
enum dig_fit_care { DIG_FIT_BARE, DIG_FIT_THOROUGH };

/// Fits. start: numbers to start from (place, u, contrast). Some hundred microseconds a start.
void dig_hypothesis_fit(const struct dig_whitened_digs *batch,
                        const struct dig_hypothesis *hypothesis, const double start[],
                        enum dig_fit_care care, struct dig_fitted *fitted);

/// Fits something that has no name beside the hypothesis of a fit, of the size that explains most;
/// the misfit pays for the choice of it.
void dig_hypothesis_fit_unlisted(const struct dig_whitened_digs *batch,
                                 const struct dig_fitted *beside, struct dig_fitted *fitted);

/// Features that a fit makes of one dig, units of the table.
void dig_fitted_features(const struct dig_soil *soil, const struct dig_fitted *fitted,
                         const struct dig_measured *dig, double feature[DIG_FEATURES]);

/// y of them in a group of the batch.
void dig_fitted_whitened(const struct dig_whitened_digs *batch, const struct dig_fitted *fitted,
                         size_t group, const struct dig_measured *dig, double y[DIG_FEATURES]);

/// The whole curve.
void dig_fitted_curve(const struct dig_soil *soil, const struct dig_fitted *fitted,
                      const struct dig_measured *dig,
                      double                     curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// The bounds of a hypothesis' numbers: the table's gravels, or some beyond; an effect's range.
void dig_hypothesis_bounds(const struct dig_soil *soil, const struct dig_hypothesis *hypothesis,
                           double low[], double high[]);

/// What the groups' means are uncertain by, at a fit.
void dig_hypothesis_errors(const struct dig_whitened_digs *batch, const struct dig_fitted *fitted,
                           struct dig_common_error error[]);

#endif // DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H
