// Peak and energy of a whole dig, as they are to be expected, and how far one dig is off them.
//
// The mean of many digs is smoother than any of them: its peak lies below theirs. So the peak told
// is the mean, over the gravels that stand for the match and over draws of one dig's spread z
// (estimator/match/entry_scatter.h), of
//
//   max over points ( m + sd sqrt(1 - v) z ),    v = sum w^2 / n
//
// m: the table's mean at the gravel, of n packings at each corner of weight w. It has itself the
// share v of one dig's variance in it, by which it peaks too high already; what is added makes the
// whole of one dig's. Of a table with one packing a gravel the peak is the table's, which is a
// dig's.
//
// Energy is linear in the curve: that of the mean curve is the one to be expected. Variance of
// both: law of total variance, of one dig about a mean of few (1 + 1/n) and between the gravels.

#ifndef DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H
#define DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H

#include "core/curve.h"
#include "estimator/match/entry_scatter.h"
#include "estimator/match/gravel_match.h"

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

/// At the match, along one trajectory, the table's scale. Fails as dig_predict_curve() does, and
/// then *whole is unchanged. Off the tick: a millisecond, 60 kB of stack, no allocation. The
/// same of the same match, always.
DIG_MUST_CHECK enum dig_status dig_peak_energy_predict(const struct dig_curve_set *set,
                                                       const struct dig_match     *match,
                                                       size_t                      trajectory,
                                                       struct dig_peak_energy     *whole);

#endif // DIG_ESTIMATOR_PREDICT_PEAK_ENERGY_H
