// Fits a hypothesis, a gravel with effects of the soil or none, to the digs of a campaign. All its
// numbers are fitted together, by least misfit (closed_loop/fit/likelihood.h).

#ifndef DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H
#define DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H

#include "closed_loop/fit/common_error.h"
#include "closed_loop/fit/forward.h"
#include "closed_loop/fit/steps.h"

/// number, low and high: the gravel's place (-1 … 1 on each axis of the table), then u and contrast
/// of each effect (DIG_AT_U, DIG_AT_CONTRAST).
struct dig_fitted {
    struct dig_hypothesis hypothesis;
    double                number[DIG_HYPOTHESIS_NUMBERS];
    double                low[DIG_HYPOTHESIS_NUMBERS]; // 90 % interval: posterior.h fills it
    double                high[DIG_HYPOTHESIS_NUMBERS];
    double noise[DIG_TRAJECTORY_MAX]; // variance of a group's mean beyond 1/n, in those of one dig
    double misfit;                    // -2 log likelihood
    double squares;                   // its part that is not a logarithm
    double means;                     // of squares, the part of the means and of z
    double z[DIG_STEPS_MAX];          // of the batch's steps (closed_loop/fit/steps.h)
};

/// Where to start a fit from: the numbers given, or those and four corners of the table as well.
enum dig_fit_care { DIG_FIT_BARE, DIG_FIT_THOROUGH };

/// Fits the hypothesis from start[DIG_HYPOTHESIS_NUMBERS]; low and high stay unset. It cannot fail.
/// Some hundred microseconds a start.
void dig_hypothesis_fit(const struct dig_batch *batch, const struct dig_hypothesis *hypothesis,
                        const double start[], enum dig_fit_care care, struct dig_fitted *fitted);

/// Fits what has no name beside the hypothesis of a fit, of the size that explains most. The choice
/// of the size costs misfit.
void dig_hypothesis_fit_unlisted(const struct dig_batch *batch, const struct dig_fitted *beside,
                                 struct dig_fitted *fitted);

/// Features of one dig as a fit predicts it, N m and N at rig scale.
void dig_fitted_features(const struct dig_soil *soil, const struct dig_fitted *fitted,
                         const struct dig_measured *dig, double feature[DIG_FEATURES]);

/// The same, whitened as the group of the batch.
void dig_fitted_whitened(const struct dig_batch *batch, const struct dig_fitted *fitted,
                         size_t group, const struct dig_measured *dig, double y[DIG_FEATURES]);

/// Its curve over path progress, N m and N at rig scale.
void dig_fitted_curve(const struct dig_soil *soil, const struct dig_fitted *fitted,
                      const struct dig_measured *dig,
                      double                     curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// Bounds of a hypothesis' numbers: the table's grid, or some beyond; each effect's range.
void dig_hypothesis_bounds(const struct dig_soil *soil, const struct dig_hypothesis *hypothesis,
                           double low[], double high[]);

/// Covariance of each group's mean at a fit, error[groups].
void dig_hypothesis_errors(const struct dig_batch *batch, const struct dig_fitted *fitted,
                           struct dig_common_error error[]);

#endif // DIG_CLOSED_LOOP_FIT_HYPOTHESIS_H
