#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/accuracy/judge.h"
#include "closed_loop/accuracy/score.h"
#include "closed_loop/recordings/regressors.h"
#include "closed_loop/search/cross_validation.h"
#include "closed_loop/search/unlisted.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void add_parameter(const char *const name, const double value, const double low,
                          const double high, struct dig_model_effect *const made)
{
    struct dig_model_parameter *const to = &made->parameter[made->parameters++];
    (void)snprintf(to->name, sizeof to->name, "%s", name);
    to->value = value;
    to->low   = low;
    to->high  = high;
}

// Numbers of a fitted effect as a model file and a report have them.
static struct dig_model_effect effect_of(const struct dig_soil *const   soil,
                                         const struct dig_fitted *const fitted, const size_t effect,
                                         const double probability)
{
    const enum dig_effect_id       id    = fitted->hypothesis.effect[effect];
    const size_t                   n     = DIG_AT_U(effect);
    const struct dig_effect *const known = dig_effect_of(id);
    struct dig_model_effect        made  = { .effect = id, .probability = probability };
    add_parameter(known != NULL ? known->parameter[0].name : "magnitude",
                  dig_soil_magnitude(soil, id, fitted->number[n]),
                  dig_soil_magnitude(soil, id, fitted->low[n]),
                  dig_soil_magnitude(soil, id, fitted->high[n]), &made);
    if (known != NULL && id == DIG_EFFECT_RATE_DEPENDENCE) {
        add_parameter(known->parameter[1].name, soil->along, soil->along, soil->along, &made);
    }
    if (known != NULL && known->contrasted) {
        add_parameter(known->parameter[1].name, fitted->number[n + 1], fitted->low[n + 1],
                      fitted->high[n + 1], &made);
    }
    return made;
}

// The same of a rock that lies elsewhere than the table's.
static struct dig_model_effect rock_of(const struct dig_rock *const rock, const double probability)
{
    struct dig_model_effect made = { .effect = DIG_EFFECT_OBSTACLE, .probability = probability };
    add_parameter(dig_effect_of(DIG_EFFECT_OBSTACLE)->parameter[1].name, rock->ahead_m, rock->low_m,
                  rock->high_m, &made);
    return made;
}

static bool is_lifting(const struct dig_curve_set *const set, const size_t trajectory,
                       const size_t bin)
{
    const struct dig_bin points = dig_feature_bin(bin);
    return dig_regressors_is_lifted(
        set, trajectory, 0.5 * (double)(points.from + points.to - 1) / (DIG_CURVE_POINTS - 1));
}

// Sums squares over the scatter's by part: what[] is in units of the table.
static void sum_by_part(const struct dig_trace_work *const w, const struct dig_group *const group,
                        const double what[DIG_FEATURES], const double variance,
                        double sum[DIG_TRACE_PHASES], double count[DIG_TRACE_PHASES])
{
    for (size_t i = 0; i < group->features; i++) {
        const size_t        f        = group->feature[i];
        const enum dig_part part     = is_lifting(w->set, group->trajectory, f % DIG_FEATURE_BINS)
                                           ? DIG_PART_LIFTED
                                           : DIG_PART_SOIL;
        const double        relative = what[f] / group->amplitude[f / DIG_FEATURE_BINS];
        sum[part] +=
            relative * relative / (w->scatter->covariance[group->trajectory][f][f] * variance);
        count[part] += 1.0;
    }
}

// The part of a dig in which a fitted effect is largest against the scatter.
static enum dig_part seen_in(const struct dig_trace_work *const w,
                             const struct dig_fitted *const fitted, const size_t effect)
{
    double            sum[DIG_TRACE_PHASES]   = { 0.0 };
    double            count[DIG_TRACE_PHASES] = { 0.0 };
    struct dig_fitted without                 = *fitted;
    without.number[DIG_AT_U(effect)]          = 0.0;
    for (size_t i = 0; i < w->batch->digs; i++) {
        const struct dig_measured *const dig = &w->measured[w->batch->dig[i].measured];
        double                           with[DIG_FEATURES];
        double                           plain[DIG_FEATURES];
        dig_fitted_features(w->soil, fitted, dig, with);
        dig_fitted_features(w->soil, &without, dig, plain);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            with[f] -= plain[f];
        }
        sum_by_part(w, &w->batch->group[w->batch->dig[i].group], with, 1.0, sum, count);
    }
    return sum[DIG_PART_LIFTED] > sum[DIG_PART_SOIL] ? DIG_PART_LIFTED : DIG_PART_SOIL;
}

void dig_trace_fill_residuals(const struct dig_trace_work *const w,
                              double                             residual[DIG_TRACE_PHASES])
{
    double sum[DIG_TRACE_PHASES]   = { 0.0 };
    double count[DIG_TRACE_PHASES] = { 0.0 };
    for (size_t g = 0; g < w->batch->groups; g++) {
        const struct dig_group *const group = &w->batch->group[g];
        double                        model[DIG_FEATURES];
        double                        mean[DIG_FEATURES] = { 0.0 };
        dig_fitted_features(w->soil, &w->search->plain, dig_batch_first(w->batch, g), model);
        for (size_t i = 0; i < w->batch->digs; i++) {
            if (w->batch->dig[i].group != g) {
                continue;
            }
            double feature[DIG_FEATURES];
            dig_batch_features(&w->measured[w->batch->dig[i].measured], feature);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                mean[f] += feature[f] / (double)group->digs;
            }
        }
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            mean[f] -= model[f];
        }
        sum_by_part(w, group, mean, 1.0 / (double)group->digs + w->search->plain.noise[g], sum,
                    count);
    }
    for (size_t p = 0; p < DIG_TRACE_PHASES; p++) {
        residual[p] = count[p] > 0.0 ? sqrt(sum[p] / count[p]) : (double)NAN;
    }
}

// v of a dig at a fitted hypothesis: what its trajectory's digs share, but of approaches its own.
// Of a trajectory that no dig was fitted along the surface's.
static double noise_of(const struct dig_trace_work *const w, const struct dig_fitted *const fitted,
                       const struct dig_measured *const dig)
{
    const size_t trajectory = (size_t)dig->trajectory;
    for (size_t g = 0; g < w->batch->groups; g++) {
        if (w->batch->group[g].trajectory == trajectory) {
            return fitted->noise[g] - dig_common_error_of_approaches(&w->batch->group[g]) +
                   dig->added.noise;
        }
    }
    return dig_response_surface_noise(w->surface, trajectory, fitted->number) + dig->added.noise;
}

static void add_unlisted(const struct dig_model_unlisted *const unlisted, const size_t trajectory,
                         double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double squares = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            squares += curve[c][k] * curve[c][k] / DIG_CURVE_POINTS;
        }
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve[c][k] += sqrt(squares) * (double)unlisted->share[trajectory][c][k];
        }
    }
}

// By the gravel of a fitted hypothesis, its effects in the mean alone.
static void predict(const struct dig_trace_work *const w, const struct dig_fitted *const fitted,
                    const struct dig_measured *const dig, struct dig_predicted *const p)
{
    dig_fitted_curve(w->soil, fitted, dig, p->value);
    dig_judge_sd(w->surface, w->scatter, (size_t)dig->trajectory, fitted->number,
                 noise_of(w, fitted, dig), p->sd);
}

void dig_trace_fill_curves(const struct dig_trace_work *const     w,
                           const struct dig_model_unlisted *const unlisted,
                           struct dig_trace_curves                curves[])
{
    const struct dig_fitted *const chosen = &w->search->chosen;
    for (size_t i = 0; i < w->digs; i++) {
        const struct dig_measured *const dig        = &w->measured[i];
        const size_t                     trajectory = (size_t)dig->trajectory;
        struct dig_trace_curves *const   of         = &curves[i];
        double                           plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        predict(w, &w->before, dig, &of->before);
        predict(w, chosen, dig, &of->after);
        if (unlisted->any) {
            add_unlisted(unlisted, trajectory, of->after.value);
        }
        dig_response_surface_curve(w->surface, trajectory, chosen->number, plain);
        dig_judge_sd_of_dug((const double(*)[DIG_CURVE_POINTS])plain,
                            (const double(*)[DIG_CURVE_POINTS])of->after.value, of->after.sd);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                of->before.sd[c][k] = hypot(of->before.sd[c][k], dig->added.error[c][k]);
                of->after.sd[c][k]  = hypot(of->after.sd[c][k], dig->added.error[c][k]);
                of->after.value[c][k] += dig->machine[c][k];
            }
        }
    }
}

// Error of the prediction (docs/numerics.md) of the fitted digs by one candidate.
static double fit_error(const struct dig_trace_work *const w, const struct dig_fitted *const fitted)
{
    static const double no_sd[DIG_CURVE_POINTS] = { 0.0 };
    struct dig_score    all                     = { 0 };
    for (size_t i = 0; i < w->batch->digs; i++) {
        const struct dig_measured *const dig = &w->measured[w->batch->dig[i].measured];
        double                           curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_fitted_curve(w->soil, fitted, dig, curve);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve[DIG_CHANNEL_MY_Nm][k] += dig->machine[DIG_CHANNEL_MY_Nm][k];
        }
        dig_score_add(&all, &w->set->trajectory[dig->trajectory], w->set->tooth_m, dig->first,
                      dig->last, dig->value[DIG_CHANNEL_MY_Nm], curve[DIG_CHANNEL_MY_Nm], no_sd);
    }
    return dig_score_error(&all);
}

void dig_trace_fill_candidates(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    const struct dig_search *const s = w->search;
    if (s->is_rock && trace->candidates < DIG_TRACE_CANDIDATES_MAX) {
        // It is looked for when all else has failed, and was in no bootstrap.
        trace->candidate[trace->candidates++] =
            (struct dig_candidate){ .as           = rock_of(&s->rock, (double)NAN),
                                    .log_evidence = s->rock.log_evidence,
                                    .p_fit        = s->rock.p_fit,
                                    .error        = (double)NAN,
                                    .seen_in      = DIG_PART_SOIL };
    }
    for (size_t i = 0; i < s->rivals && trace->candidates < DIG_TRACE_CANDIDATES_MAX; i++) {
        const struct dig_rival *const  rival = &s->rival[i];
        const struct dig_fitted *const f     = &rival->fitted;
        trace->candidate[trace->candidates++] =
            (struct dig_candidate){ .as           = effect_of(w->soil, f, 0, rival->inclusion),
                                    .log_evidence = rival->log_evidence,
                                    .p_fit        = rival->p_fit,
                                    .error        = fit_error(w, f),
                                    .seen_in      = seen_in(w, f, 0) };
    }
}

static void fill_sets(const struct dig_search *const s, const struct dig_machine_finding *const air,
                      struct dig_trace *const trace)
{
    for (size_t i = 0; i < air->sets && trace->sets < DIG_TRACE_SETS_MAX; i++) {
        trace->set[trace->sets++] = air->set[i];
    }
    if (s->alike.effects > 0 && trace->sets < DIG_TRACE_SETS_MAX) {
        trace->set[trace->sets++] = s->alike;
    }
}

// Without free air what the digs show may be the machine's: no more than even odds are claimed.
static double claimed(const struct dig_machine_finding *const air, const double probability)
{
    return air->no_air ? fmin(probability, DIG_TRACE_UNCONFIRMED) : probability;
}

// What has no name is seen where the digs' residual is largest.
static enum dig_part largest_part(const double residual[DIG_TRACE_PHASES])
{
    return residual[DIG_PART_LIFTED] > residual[DIG_PART_SOIL] ? DIG_PART_LIFTED : DIG_PART_SOIL;
}

void dig_trace_doubt_soil(struct dig_trace_work *const w)
{
    assert(w != NULL);
    const struct dig_machine_finding *const air    = w->air;
    struct dig_search *const                search = w->search;
    if (air->unexplained && search->significant && !search->outside) {
        search->unlisted      = true;
        search->is_rock       = false;
        search->alike.effects = 0;
    }
}

// A correction without a name was tried on the digs of each trajectory in turn
// (closed_loop/search/unlisted.h): that says nothing where every trajectory was dug once.
static bool was_tried(const struct dig_batch *const batch)
{
    bool tried = false;
    for (size_t g = 0; g < batch->groups; g++) {
        tried = tried || batch->group[g].digs > 1;
    }
    return tried;
}

void dig_trace_confirm_without_air(struct dig_trace_work *const w)
{
    assert(w != NULL);
    const struct dig_search *const s = w->search;
    w->confirmed                     = true;
    if (w->air->no_air && s->significant) {
        w->confirmed = s->unlisted
                           ? was_tried(w->batch)
                           : dig_cross_validation_gain(w->batch, &s->plain, &s->chosen) > 0.0;
    }
}

// NOLINTNEXTLINE(readability-function-cognitive-complexity): one step after another
void dig_trace_fill_verdict(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    assert(w != NULL && trace != NULL);
    const struct dig_machine_finding *const air = w->air;
    const struct dig_search *const          s   = w->search;
    fill_sets(s, air, trace);
    for (size_t e = 0; e < air->effects; e++) {
        trace->seen_in[trace->effects]  = air->by_digs ? DIG_PART_SOIL : DIG_PART_AIR;
        trace->effect[trace->effects++] = air->effect[e];
    }
    for (size_t e = 0; s->significant && !s->unlisted && e < s->chosen.hypothesis.effects &&
                       trace->effects < DIG_MODEL_EFFECTS_MAX;
         e++) {
        trace->seen_in[trace->effects] = seen_in(w, &s->chosen, e);
        trace->effect[trace->effects++] =
            effect_of(w->soil, &s->chosen, e, claimed(air, s->probability[e]));
    }
    const bool of_soil = s->significant && s->unlisted;
    if ((of_soil || air->unexplained) && trace->effects < DIG_MODEL_EFFECTS_MAX) {
        trace->unlisted.any = true;
        if (of_soil) {
            dig_unlisted_correct(w->batch, &s->chosen, &trace->unlisted);
        }
        (void)snprintf(trace->unlisted.depends_on, sizeof trace->unlisted.depends_on, "%s",
                       s->is_rock             ? "where the rock lies"
                       : of_soil              ? s->without_name.depends_on
                       : air->follows != NULL ? air->follows
                                              : "the machine's motion in free air");
        const double in_soil = claimed(air, s->unnamed * (1.0 - s->p_complete));
        trace->seen_in[trace->effects] =
            !of_soil ? DIG_PART_AIR : (s->is_rock ? DIG_PART_SOIL : largest_part(trace->residual));
        const struct dig_model_effect unnamed = {
            .effect = DIG_EFFECT_UNLISTED,
            .probability =
                of_soil ? in_soil
                        : s->unnamed * fmax(1.0 - air->p_complete, 1.0 - w->settings->false_alarm)
        };
        trace->effect[trace->effects++] = s->is_rock ? rock_of(&s->rock, in_soil) : unnamed;
    }
}
