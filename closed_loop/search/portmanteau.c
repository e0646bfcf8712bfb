#include "closed_loop/search/portmanteau.h"

#include "closed_loop/numeric/dense.h"
#include "closed_loop/search/null_simulation.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>

enum { BOOTSTRAPS = 1000 };

double dig_portmanteau(const size_t n, const double z[])
{
    assert(n == 0 || z != NULL);
    const double squares = dig_product(n, z, z);
    double       sum     = 0.0;
    for (size_t lag = 1; squares > 0.0 && lag <= DIG_PORTMANTEAU_LAGS && lag < n; lag++) {
        double r = 0.0;
        for (size_t k = 0; k + lag < n; k++) {
            r += z[k] * z[k + lag] / squares;
        }
        sum += r * r / (double)(n - lag);
    }
    return (double)n * ((double)n + 2.0) * sum;
}

// Q of every dig; returns their mean.
static double all_digs(const struct dig_whitened_digs *const batch,
                       const struct dig_fitted *const fitted, double q[DIG_MEASURED_MAX])
{
    double mean = 0.0;
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_whitened_digs_dig *const   dig   = &batch->dig[i];
        const struct dig_whitened_digs_group *const group = &batch->group[dig->group];
        double                                      model[DIG_FEATURES];
        double                                      z[DIG_FEATURES];
        dig_fitted_whitened(batch, fitted, dig->group, &batch->measured[dig->measured], model);
        q[i]         = 0.0;
        size_t first = 0;
        for (size_t k = 0; k < group->features; k++) {
            const size_t channel = group->feature[k] / DIG_FEATURE_BINS;
            z[k]                 = dig->y[k] - model[k];
            if (k + 1 == group->features || group->feature[k + 1] / DIG_FEATURE_BINS != channel) {
                q[i] += dig_portmanteau(k + 1 - first, z + first);
                first = k + 1;
            }
        }
        mean += q[i] / (double)batch->digs;
    }
    return mean;
}

static void draw_digs(const size_t digs, const double q[], uint64_t *const seed,
                      struct dig_whiteness *const whiteness)
{
    double drawn[BOOTSTRAPS];
    for (size_t b = 0; b < BOOTSTRAPS; b++) {
        drawn[b] = 0.0;
        for (size_t i = 0; i < digs; i++) {
            drawn[b] += q[dig_chance_index(seed, digs)] / (double)digs;
        }
    }
    dig_chance_interval(BOOTSTRAPS, drawn, &whiteness->low, &whiteness->high);
}

struct dig_whiteness dig_portmanteau_judge(const struct dig_whitened_digs *const batch,
                                           const struct dig_fitted *const        fitted,
                                           const size_t draws, uint64_t seed)
{
    assert(batch != NULL && fitted != NULL && draws > 0);
    double                   q[DIG_MEASURED_MAX];
    double                   as_large = 0.0;
    struct dig_common_error  error[DIG_TRAJECTORY_MAX];
    struct dig_whitened_digs drawn = *batch;
    struct dig_whiteness     made  = { .digs = batch->digs };
    made.statistic                 = all_digs(batch, fitted, q);
    draw_digs(batch->digs, q, &seed, &made);
    dig_hypothesis_errors(batch, fitted, error);
    for (size_t d = 0; d < draws; d++) {
        struct dig_fitted again;
        dig_null_simulation_digs(batch, fitted, error, &seed, &drawn);
        dig_hypothesis_fit(&drawn, &fitted->hypothesis, fitted->number, DIG_FIT_BARE, &again);
        const double mean = all_digs(&drawn, &again, q);
        made.expected += mean / (double)draws;
        as_large += mean >= made.statistic ? 1.0 : 0.0;
    }
    made.p = (as_large + 1.0) / ((double)draws + 1.0);
    return made;
}
