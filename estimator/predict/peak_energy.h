// Expected peak and energy of a whole dig, and their standard deviation for one dig.
//
// The mean of many digs is smoother than each: its peak lies below theirs. So the expected peak is
// the mean, over the samples of the match and over draws of one dig's scatter z
// (estimator/match/entry_scatter.h), of
//
//   max over points ( m + sd sqrt(1 - v) z ),    v = sum w^2 / n
//
// m: the table's mean at the gravel, of n packings at each corner of weight w. It already contains
// the share v of one dig's variance; the draw adds the rest. With one packing a gravel the peak is
// the table's, which is a single dig's.
//
// Energy is linear in the curve: its expectation is that of the mean curve. Variance of both: law
// of total variance, of one dig about a mean of few (1 + 1/n) and between the gravels.

#ifndef DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H
#define DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H

#include "core/curve.h"
#include "core/gravel_match.h"
#include "estimator/match/entry_scatter.h"

struct dig_peak_energy {
    double peak_Nm, peak_sigma_Nm; // of the moment; 1 sigma of one dig
    double energy_J, energy_sigma_J;
};

/// Work the bucket does on the soil along the whole trajectory, the curve's scale:
///
///   energy = - integral F . v_pin dt + integral My theta_dot dt
///
/// theta turns against +y, and My > 0 resists it, so both terms are positive when the soil resists.
/// It is linear in the curve: the sum over channels and points of these weights times it
/// (trapezoids over the path).
void dig_peak_energy_weights(const struct dig_trajectory *trajectory, double tooth_m,
                             struct dig_channels *weight);

/// Predicts both along one trajectory, at the table's scale. Fails as dig_predict_curve(); *whole
/// is unchanged then. Deterministic. Off the tick: a millisecond, 60 kB of stack, no allocation.
DIG_MUST_CHECK enum dig_status dig_peak_energy_predict(const struct dig_curve_set *set,
                                                       const struct dig_match     *match,
                                                       size_t                      trajectory,
                                                       struct dig_peak_energy     *whole);

#endif // DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H
