#include "tables/derive.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// The piecewise-linear signal at at_s, held at its ends.
static double value_at(const size_t n, const double first_s, const double step_s, const double y[],
                       const double at_s)
{
    const double index = (at_s - first_s) / step_s;
    if (!(index > 0.0)) {
        return y[0];
    }
    if (index >= (double)(n - 1)) {
        return y[n - 1];
    }
    const size_t before = (size_t)index;
    const double part   = index - (double)before;
    return y[before] + part * (y[before + 1] - y[before]);
}

enum dig_status dig_derive_run(const struct dig_trajectory *const trajectory, const double tooth_m,
                               const double half_s, const size_t windows, const double first_s,
                               const double step_s, const float value[],
                               double out[const DIG_CHANNELS][DIG_CURVE_POINTS])
{
    assert(trajectory != NULL && windows >= 2 && step_s > 0.0);

    double *const block = malloc(3 * windows * sizeof *block);
    if (block == NULL) {
        return DIG_ENOMEM;
    }
    double *const t_s    = block;
    double *const y      = block + windows;
    double *const smooth = block + 2 * windows;
    for (size_t i = 0; i < windows; i++) {
        t_s[i] = first_s + (double)i * step_s;
    }
    double at_s[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        at_s[k] = dig_trajectory_time_s(trajectory, tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
    }
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        for (size_t i = 0; i < windows; i++) {
            y[i] = (double)value[c * windows + i];
        }
        dig_curve_smooth(windows, t_s, y, half_s, smooth);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            out[c][k] = value_at(windows, first_s, step_s, smooth, at_s[k]);
        }
    }
    free(block);
    return DIG_OK;
}

// Welford's recurrence: no difference of two large sums.
void dig_ensemble_add(struct dig_ensemble *const ensemble,
                      const double               run[const DIG_CHANNELS][DIG_CURVE_POINTS])
{
    ensemble->packings++;
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double off = run[c][k] - ensemble->mean[c][k];
            ensemble->mean[c][k] += off / (double)ensemble->packings;
            ensemble->squares[c][k] += off * (run[c][k] - ensemble->mean[c][k]);
        }
    }
}

void dig_ensemble_curve(const struct dig_ensemble *const ensemble, struct dig_curve *const curve)
{
    const size_t n = ensemble->packings;
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        curve->error[c] = 0.0F;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[c][k] = (float)ensemble->mean[c][k];
            curve->sd[c][k] =
                n > 1 ? (float)sqrt(ensemble->squares[c][k] / (double)(n - 1)) : (float)NAN;
        }
    }
}

void dig_floats_pack(const size_t n, const float value[], uint8_t bytes[])
{
    for (size_t i = 0; i < n; i++) {
        uint32_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        for (size_t b = 0; b < 4; b++) {
            bytes[4 * i + b] = (uint8_t)(bits >> (8 * b));
        }
    }
}

void dig_floats_unpack(const size_t n, const uint8_t bytes[], float value[])
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t *const b = bytes + 4 * i;
        const uint32_t       bits =
            (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
        memcpy(&value[i], &bits, sizeof bits);
    }
}

bool dig_channels_sound(const size_t n, const float value[])
{
    size_t finite  = 0;
    size_t unknown = 0;
    for (size_t i = 0; i < DIG_FORCE_CHANNELS * n; i++) {
        finite += isfinite(value[i]) ? 1 : 0;
    }
    for (size_t i = DIG_FORCE_CHANNELS * n; i < DIG_CHANNELS * n; i++) {
        finite += isfinite(value[i]) ? 1 : 0;
        unknown += isnan(value[i]) ? 1 : 0;
    }
    return finite == DIG_CHANNELS * n || (finite == DIG_FORCE_CHANNELS * n && unknown == n);
}
