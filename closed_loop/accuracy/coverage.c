#include "closed_loop/accuracy/coverage.h"

#include <assert.h>
#include <math.h>

void dig_coverage_add(struct dig_coverage *const coverage, const struct dig_observation *const dig,
                      const struct dig_curve *const curve)
{
    assert(coverage != NULL && dig != NULL && curve != NULL);
    for (size_t c = 0; c < (dig->forces ? DIG_FORCE_CHANNELS : 1); c++) {
        const double *const value = c == 0 ? dig->moment_Nm : dig->force_N[c - 1];
        const double *const sigma = c == 0 ? dig->sigma_Nm : dig->force_sigma_N[c - 1];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double at   = (double)k / (DIG_CURVE_POINTS - 1);
            const double band = DIG_COVERAGE_SIGMAS * hypot((double)curve->sd[c][k], sigma[k]);
            if (at >= dig->first && at <= dig->last) {
                coverage->points[c]++;
                coverage->inside[c] += fabs(value[k] - (double)curve->mean[c][k]) <= band ? 1 : 0;
            }
        }
    }
}

double dig_coverage_share(const struct dig_coverage *const coverage, const enum dig_channel channel)
{
    assert(coverage != NULL && (int)channel < DIG_FORCE_CHANNELS);
    return coverage->points[channel] > 0
               ? (double)coverage->inside[channel] / (double)coverage->points[channel]
               : (double)NAN;
}
