#include "closed_loop/accuracy/judge.h"

#include "closed_loop/accuracy/score.h"
#include "closed_loop/model/soil_fit.h"
#include "closed_loop/recordings/features.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { DRAWS = 1000 };

void dig_judge_sd(const struct dig_response_surface *const surface,
                  const struct dig_scatter *const scatter, const size_t trajectory,
                  const double place[DIG_AXES], const double noise,
                  double sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const struct dig_curve_set *const set                                       = surface->set;
    double                            sum[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
    double                            n[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]   = { { 0.0 } };
    double                            feature[DIG_FEATURES];
    double                            size[DIG_FORCE_CHANNELS];
    dig_response_surface_features(surface, trajectory, place, feature, size);
    const double strength = dig_soil_strength(surface, place, size);
    const double factor   = dig_scatter_factor(scatter, trajectory, strength) * (1.0 + noise);

    // Mean over the table's entries of (sd / amplitude)^2 at each point.
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot   = e * set->trajectories + trajectory;
        const double weight = fmax((double)set->packings[slot] - 1.0, 0.5);
        double       at[DIG_AXES];
        double       amplitude[DIG_FORCE_CHANNELS];
        dig_response_surface_place(surface, &set->gravel[e], at);
        dig_response_surface_features(surface, trajectory, at, feature, amplitude);
        for (size_t i = 0; i < (size_t)DIG_FORCE_CHANNELS * DIG_CURVE_POINTS; i++) {
            const size_t c   = i / DIG_CURVE_POINTS;
            const size_t k   = i % DIG_CURVE_POINTS;
            const double own = (double)set->curve[slot].sd[c][k] / amplitude[c];
            if (set->packings[slot] > 0 && isfinite(own)) {
                sum[c][k] += weight * own * own;
                n[c][k] += weight;
            }
        }
    }
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sd[c][k] = size[c] * sqrt(factor * (n[c][k] > 0.0 ? sum[c][k] / n[c][k] : 0.0));
        }
    }
}

void dig_judge_sd_of_dug(const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                         const double dug[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                         double       sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    double feature[DIG_FEATURES];
    double alone[DIG_FORCE_CHANNELS];
    double all[DIG_FORCE_CHANNELS];
    dig_features_of(plain, feature);
    dig_features_amplitude(feature, NULL, alone);
    dig_features_of(dug, feature);
    dig_features_amplitude(feature, NULL, all);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sd[c][k] *= all[c] / alone[c];
        }
    }
}

static void join(struct dig_score *const sum, const struct dig_score *const one)
{
    sum->wrong_N2m2s += one->wrong_N2m2s;
    sum->floor_N2m2s += one->floor_N2m2s;
    sum->whole_N2m2s += one->whole_N2m2s;
}

// Scores of the moment of the digs taken, one by one and all together; how many.
static size_t score_each(const struct dig_judged *const judged, const bool take[], const bool after,
                         struct dig_score one[DIG_MEASURED_MAX], struct dig_score *const all)
{
    const struct dig_curve_set *const set = judged->set;
    size_t                            n   = 0;
    *all                                  = (struct dig_score){ 0 };
    assert(judged->digs <= DIG_MEASURED_MAX);
    for (size_t i = 0; i < judged->digs; i++) {
        const struct dig_measured *const  dig = &judged->measured[i];
        const struct dig_predicted *const predicted =
            after ? &judged->curves[i].after : &judged->curves[i].before;
        if (take[i]) {
            one[n] = (struct dig_score){ 0 };
            dig_score_add(&one[n], &set->trajectory[dig->trajectory], set->tooth_m, dig->first,
                          dig->last, dig->value[DIG_CHANNEL_MY_Nm],
                          predicted->value[DIG_CHANNEL_MY_Nm], predicted->sd[DIG_CHANNEL_MY_Nm]);
            join(all, &one[n++]);
        }
    }
    return n;
}

struct dig_error_range dig_judge_error(const struct dig_judged *const judged, const bool take[],
                                       const bool after, const uint64_t seed)
{
    assert(judged != NULL);
    struct dig_score       one[DIG_MEASURED_MAX];
    struct dig_score       all;
    const size_t           n     = score_each(judged, take, after, one, &all);
    struct dig_error_range range = { (double)NAN, (double)NAN, (double)NAN };
    if (n == 0) {
        return range;
    }
    range.value = dig_score_error(&all);
    range.low   = range.value;
    range.high  = range.value;
    if (n > 1) {
        uint64_t state = seed;
        double   drawn[DRAWS];
        for (size_t d = 0; d < DRAWS; d++) {
            struct dig_score sum = { 0 };
            for (size_t i = 0; i < n; i++) {
                join(&sum, &one[dig_chance_index(&state, n)]);
            }
            drawn[d] = dig_score_error(&sum);
        }
        dig_chance_interval(DRAWS, drawn, &range.low, &range.high);
    }
    return range;
}

double dig_judge_floor(const struct dig_judged *const judged, const bool take[])
{
    assert(judged != NULL);
    struct dig_score one[DIG_MEASURED_MAX];
    struct dig_score all;
    const size_t     n = score_each(judged, take, true, one, &all);
    return n > 0 ? dig_score_noise_floor(&all) : (double)NAN;
}

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
