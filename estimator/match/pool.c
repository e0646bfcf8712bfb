#include "estimator/match/pool.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void dig_pool_add(struct dig_pool *const pool, const struct dig_observation *const dig)
{
    assert(pool != NULL && dig != NULL);
    if (pool->digs == DIG_POOL_MAX) {
        memmove(&pool->dig[0], &pool->dig[1], (DIG_POOL_MAX - 1) * sizeof pool->dig[0]);
        pool->digs--;
    }
    pool->dig[pool->digs++] = *dig;
}

static struct dig_pooled *group_of(struct dig_pool_sums *const sums, const size_t trajectory)
{
    size_t g = 0;
    while (g < sums->groups && sums->group[g].trajectory != trajectory) {
        g++;
    }
    if (g == sums->groups) {
        assert(g < DIG_TRAJECTORY_MAX);
        sums->group[g] = (struct dig_pooled){ .trajectory = trajectory, .forces = true };
        sums->groups++;
    }
    return &sums->group[g];
}

// Mean and sum of squares about it, updated by one value (Welford 1962).
static void add(struct dig_pooled *const group, const struct dig_observation *const dig)
{
    group->forces         = group->forces && dig->forces;
    const size_t channels = group->forces ? DIG_FORCE_CHANNELS : 1;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at < dig->first || at > dig->last) {
            continue;
        }
        const double moment_Nm = dig->moment_Nm[k];
        const double off_Nm    = moment_Nm - group->mean[DIG_CHANNEL_MY_Nm][k];
        group->count[k] += 1.0;
        for (size_t c = 0; c < channels; c++) {
            const double value  = c == 0 ? moment_Nm : dig->force_N[c - 1][k];
            const double sigma  = c == 0 ? dig->sigma_Nm[k] : dig->force_sigma_N[c - 1][k];
            double       sigma2 = sigma * sigma;
            for (size_t j = 0; j < DIG_RUBS; j++) {
                const float  rubs = dig->rubs[j][c][k];
                float *const mean = &group->rubs[j][c][k];
                *mean += (rubs - *mean) / (float)group->count[k];
                sigma2 -= (double)rubs * (double)rubs;
                group->rubbed = group->rubbed || fabsf(rubs) > 0.0F;
            }
            group->mean[c][k] += (value - group->mean[c][k]) / group->count[k];
            group->sigma2[c][k] += (fmax(sigma2, 0.0) - group->sigma2[c][k]) / group->count[k];
        }
        group->scatter_Nm2 += off_Nm * (moment_Nm - group->mean[DIG_CHANNEL_MY_Nm][k]);
        group->norm2_Nm2 += moment_Nm * moment_Nm;
    }
}

void dig_pool_sum(const size_t digs, const struct dig_observation dig[],
                  struct dig_pool_sums *const sums)
{
    assert(digs > 0 && dig != NULL && sums != NULL);
    sums->digs      = digs;
    sums->dig_count = dig[digs - 1].dig_count;
    sums->groups    = 0;
    for (size_t d = 0; d < digs; d++) {
        add(group_of(sums, (size_t)dig[d].trajectory), &dig[d]);
    }
}
