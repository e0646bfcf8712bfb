#include "closed_loop/accuracy/decision.h"

#include "closed_loop/accuracy/score.h"
#include "closed_loop/recordings/features.h"

#include <assert.h>
#include <math.h>

// One dig: <d, d>, and the variance of <d, e>.
struct products {
    double change, scatter;
};

// How two bins of the moment move together.
static double correlation(const double covariance[DIG_FEATURES][DIG_FEATURES], const size_t a,
                          const size_t b)
{
    const size_t i   = (size_t)DIG_CHANNEL_MY_Nm * DIG_FEATURE_BINS + a;
    const size_t j   = (size_t)DIG_CHANNEL_MY_Nm * DIG_FEATURE_BINS + b;
    const double own = covariance[i][i] * covariance[j][j];
    return own > 0.0 ? covariance[i][j] / sqrt(own) : (a == b ? 1.0 : 0.0);
}

static struct products products_of(const struct dig_curve_set *const    set,
                                   const struct dig_scatter *const      scatter,
                                   const struct dig_measured *const     dig,
                                   const struct dig_trace_curves *const curves)
{
    const size_t    t                       = (size_t)dig->trajectory;
    double          moved[DIG_FEATURE_BINS] = { 0.0 }; // d times one sigma of e, over the bin
    struct products of                      = { 0.0, 0.0 };
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        const struct dig_bin points = dig_feature_bin(b);
        for (size_t k = points.from; k < points.to; k++) {
            const double at     = (double)k / (DIG_CURVE_POINTS - 1);
            const bool   dug    = at >= dig->first && at <= dig->last;
            const double time_s = dug ? dig_score_time_s(set, t, k) : 0.0;
            const double change = curves->after.value[DIG_CHANNEL_MY_Nm][k] -
                                  curves->before.value[DIG_CHANNEL_MY_Nm][k];
            of.change += time_s * change * change;
            moved[b] += time_s * change * curves->before.sd[DIG_CHANNEL_MY_Nm][k];
        }
    }
    for (size_t a = 0; a < DIG_FEATURE_BINS; a++) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            of.scatter += moved[a] * moved[b] * correlation(scatter->covariance[t], a, b);
        }
    }
    return of;
}

double dig_decision_chance_of_worse(const struct dig_judged *const  judged,
                                    const struct dig_scatter *const scatter)
{
    assert(judged != NULL && judged->digs > 0 && scatter != NULL);
    double sum = 0.0;
    for (size_t i = 0; i < judged->digs; i++) {
        const struct products of =
            products_of(judged->set, scatter, &judged->measured[i], &judged->curves[i]);
        sum += of.scatter > 0.0 ? 0.5 * erfc(of.change / sqrt(8.0 * of.scatter)) : 0.5;
    }
    return sum / (double)judged->digs;
}

bool dig_decision_brings_nearer(const struct dig_judged *const judged, const bool fit[])
{
    enum { SEED = 1 }; // of the interval, which is not asked for
    return dig_judge_error(judged, fit, true, SEED).value <
           dig_judge_error(judged, fit, false, SEED).value;
}
