#include "closed_loop/accuracy/coverage.h"

#include <assert.h>
#include <math.h>

static void add(struct dig_coverage *const coverage, const size_t channel, const double off,
                const double sd, const double sigma)
{
    coverage->points[channel]++;
    coverage->inside[channel] += fabs(off) <= DIG_COVERAGE_SIGMAS * hypot(sd, sigma) ? 1 : 0;
}

void dig_coverage_add(struct dig_coverage *const coverage, const struct dig_observation *const dig,
                      const struct dig_curve *const curve)
{
    assert(coverage != NULL && dig != NULL && curve != NULL);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at < dig->first || at > dig->last) {
            continue;
        }
        add(coverage, 0, dig->moment_Nm[k] - (double)curve->mean[0][k], (double)curve->sd[0][k],
            dig->sigma_Nm[k]);
        for (size_t c = 1; dig->forces && c < DIG_FORCE_CHANNELS; c++) {
            add(coverage, c, dig->force_N[c - 1][k] - (double)curve->mean[c][k],
                (double)curve->sd[c][k], dig->force_sigma_N[c - 1][k]);
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
