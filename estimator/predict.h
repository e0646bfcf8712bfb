// A predicted curve, read off as whole-dig numbers and ahead of the bucket. Machine scale follows
// from Froude similarity: moments and energy lambda^4, forces lambda^3.

#ifndef DIG_ESTIMATOR_PREDICT_H
#define DIG_ESTIMATOR_PREDICT_H

#include "core/curve.h"
#include "estimator/estimator.h"

/// Largest moment of the curve, its own scale.
double dig_predict_peak_Nm(const struct dig_curve *curve);

/// Work the bucket does on the soil along the whole trajectory, the curve's scale:
///
///   energy = - integral F . v_pin dt + integral My theta_dot dt
///
/// theta turns against +y, and My > 0 resists it, so both terms are positive when the soil resists.
double dig_predict_energy_J(const struct dig_trajectory *trajectory, double tooth_m,
                            const struct dig_curve *curve);

/// Fills the points of *prediction between its from_progress and to_progress.
void dig_predict_points(const struct dig_curve *curve, double lambda,
                        struct dig_prediction *prediction);

#endif // DIG_ESTIMATOR_PREDICT_H
