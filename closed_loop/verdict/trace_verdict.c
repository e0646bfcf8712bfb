#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/search/cross_validation.h"
#include "closed_loop/search/unlisted.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

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
static bool was_tried(const struct dig_whitened_digs *const batch)
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
        trace->seen_in[trace->effects] = dig_trace_seen_in(w, &s->chosen, e);
        trace->effect[trace->effects++] =
            dig_trace_effect(w->soil, &s->chosen, e, claimed(air, s->probability[e]));
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
        trace->effect[trace->effects++] = s->is_rock ? dig_trace_rock(&s->rock, in_soil) : unnamed;
    }
}
