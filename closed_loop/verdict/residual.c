#include "closed_loop/verdict/residuals.h"

#include "closed_loop/accuracy/score.h"
#include "closed_loop/recordings/regressors.h"

#include <assert.h>
#include <math.h>

// Integrals over rig time.
struct integral {
    double wrong2, over_sigma2, time_s;
};

static struct dig_residual sum_up(const struct integral *const part, const double whole2)
{
    const double              gap  = (double)NAN;
    const struct dig_residual none = { gap, gap, gap };
    return part->time_s > 0.0
               ? (struct dig_residual){ sqrt(part->wrong2 / part->time_s),
                                        whole2 > 0.0 ? sqrt(part->wrong2 / whole2) : gap,
                                        sqrt(part->over_sigma2 / part->time_s) }
               : none;
}

void dig_residual_of(const struct dig_curve_set *const set, const struct dig_measured *const dig,
                     const struct dig_trace_curves *const curves, const bool after,
                     struct dig_residual residual[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS])
{
    assert(set != NULL && dig != NULL && curves != NULL && residual != NULL);
    assert((size_t)dig->trajectory < set->trajectories);
    const size_t trajectory                          = (size_t)dig->trajectory;
    const double(*const predicted)[DIG_CURVE_POINTS] = after ? curves->after : curves->before;
    const double(*const sd)[DIG_CURVE_POINTS]        = after ? curves->after_sd : curves->before_sd;
    struct integral part[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS] = { { { .wrong2 = 0.0 } } };
    double          whole2[DIG_FORCE_CHANNELS]                 = { 0.0 };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        if (progress < dig->first || progress > dig->last) {
            continue;
        }
        const enum dig_part in =
            dig_regressors_is_lifted(set, trajectory, progress) ? DIG_PART_LIFTED : DIG_PART_SOIL;
        const double time_s = dig_score_time_s(set, trajectory, k);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const double wrong = dig->value[c][k] - predicted[c][k];
            const double sigma = hypot(sd[c][k], dig->sigma[c][k]);
            if (dig->measured[c]) {
                part[in][c].wrong2 += wrong * wrong * time_s;
                part[in][c].over_sigma2 += sigma > 0.0 ? pow(wrong / sigma, 2.0) * time_s : 0.0;
                part[in][c].time_s += time_s;
                whole2[c] += dig->value[c][k] * dig->value[c][k] * time_s;
            }
        }
    }
    for (size_t p = 0; p < DIG_TRACE_PHASES; p++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            residual[p][c] = sum_up(&part[p][c], whole2[c]);
        }
    }
}
