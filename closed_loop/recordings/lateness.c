#include "closed_loop/recordings/lateness.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// When the table's dig is at each point of progress.
static void times(const struct dig_trajectory *const trajectory, const double tooth_m,
                  double time_s[DIG_CURVE_POINTS])
{
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        time_s[k] = dig_trajectory_time_s(trajectory, tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
    }
}

void dig_lateness_rate(const struct dig_trajectory *const trajectory, const double tooth_m,
                       const struct dig_measured *const dig, double rate[DIG_FEATURES])
{
    assert(trajectory != NULL && dig != NULL && rate != NULL);
    double time_s[DIG_CURVE_POINTS];
    double slope[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
    times(trajectory, tooth_m, time_s);
    const double last = dig->last * (DIG_CURVE_POINTS - 1);
    const size_t from = (size_t)ceil(fmax(dig->first, 0.0) * (DIG_CURVE_POINTS - 1));
    const size_t to   = (size_t)floor(fmin(last, DIG_CURVE_POINTS - 1));
    for (size_t k = from; k <= to; k++) {
        const size_t before  = k > from ? k - 1 : k;
        const size_t after   = k < to ? k + 1 : k;
        const double spent_s = (time_s[after] - time_s[before]) / dig->pace;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS && spent_s > 0.0; c++) {
            slope[c][k] =
                dig->measured[c] ? (dig->value[c][after] - dig->value[c][before]) / spent_s : 0.0;
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])slope, rate);
}

void dig_lateness_share(const size_t digs, struct dig_measured measured[], const bool fit[])
{
    assert(measured != NULL && fit != NULL);
    double of_table[DIG_TRAJECTORY_MAX][DIG_FEATURES] = { { 0.0 } };
    double count[DIG_TRAJECTORY_MAX]                  = { 0.0 };
    for (size_t i = 0; i < digs; i++) {
        const struct dig_measured *const dig = &measured[i];
        if (fit[i] && dig->pace > 0.0) {
            count[dig->trajectory] += 1.0;
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                of_table[dig->trajectory][f] += dig->rate[f] / dig->pace;
            }
        }
    }
    for (size_t i = 0; i < digs; i++) {
        struct dig_measured *const dig = &measured[i];
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const double n = count[dig->trajectory];
            dig->rate[f]   = n > 0.0 ? dig->pace * of_table[dig->trajectory][f] / n : 0.0;
        }
    }
}

void dig_lateness_delay(const struct dig_trajectory *const trajectory, const double tooth_m,
                        const double pace, const double delay_s,
                        double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    assert(trajectory != NULL && curve != NULL);
    double time_s[DIG_CURVE_POINTS];
    double read[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    times(trajectory, tooth_m, time_s);
    for (size_t k = 0, i = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_s =
            fmin(fmax(time_s[k] - delay_s * pace, time_s[0]), time_s[DIG_CURVE_POINTS - 1]);
        while (i + 2 < DIG_CURVE_POINTS && time_s[i + 1] < at_s) {
            i++;
        }
        const double lasts_s = time_s[i + 1] - time_s[i];
        const double share   = lasts_s > 0.0 ? (at_s - time_s[i]) / lasts_s : 1.0;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            read[c][k] = curve[c][i] + share * (curve[c][i + 1] - curve[c][i]);
        }
    }
    memcpy(curve, read, sizeof read);
}
