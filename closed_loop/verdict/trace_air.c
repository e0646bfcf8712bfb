// What free air says of the machine, and what the digs say to that.

#include "closed_loop/accuracy/effect_size.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of -2 log likelihood of the soil, for which the air's first choice is given up.
static const double clearly_less = 12.0;

// What free air shows has no name that also fits the digs.
static void give_up_air(struct dig_machine_finding *const air)
{
    air->unexplained = true;
    air->effects     = 0;
    air->sets        = 0;
}

// A correction that leaves a dig untold (a cylinder at its stop, a bucket off its path) is none.
static enum dig_status trace_machine(struct dig_machine_side *const         machine,
                                     const struct dig_trace_settings *const settings,
                                     struct dig_trace_work *const w, struct dig_measured measured[])
{
    enum dig_status status =
        dig_machine_side_trace(machine, settings->false_alarm / 2.0, settings->seed, w->air);
    if (status == DIG_OK && w->air->effects > 0) {
        status = dig_machine_side_apply(machine, w->air->effects, w->air->effect, measured);
    }
    if (status == DIG_ENOMATCH) {
        give_up_air(w->air);
        status = dig_machine_side_apply(machine, 0, w->air->effect, measured);
    }
    return status;
}

static bool is_in(const struct dig_candidate_set *const set, const enum dig_effect_id effect)
{
    bool found = false;
    for (size_t e = 0; e < set->effects; e++) {
        found = found || set->effect[e] == effect;
    }
    return found;
}

// Of the machine's effects that free air cannot tell apart, the one that leaves least in the soil
// is kept. Leaves the batch and *plain with it.
static enum dig_status choose_in_soil(struct dig_machine_side *const machine, const size_t digs,
                                      struct dig_measured          measured[],
                                      struct dig_trace_work *const w,
                                      struct dig_fitted *const plain, struct dig_error *const error)
{
    struct dig_machine_finding *const air    = w->air;
    enum dig_status                   status = dig_trace_batch(w, digs, measured, plain, error);
    const struct dig_model_effect     first  = air->effect[0];
    double                            least  = plain->misfit - clearly_less;
    for (size_t i = 0; air->effects == 1 && air->sets > 0 && i < air->candidates; i++) {
        const struct dig_candidate *const c = &air->candidate[i];
        if (status != DIG_OK || c->effect == first.effect || !is_in(&air->set[0], c->effect)) {
            continue;
        }
        struct dig_model_effect other = { .effect      = c->effect,
                                          .probability = first.probability,
                                          .parameters  = c->parameters };
        memcpy(other.parameter, c->parameter, sizeof other.parameter);
        status = dig_machine_side_apply(machine, 1, &other, measured);
        if (status == DIG_ENOMATCH) {
            status = DIG_OK;
            continue;
        }
        if (status == DIG_OK) {
            status = dig_trace_batch(w, digs, measured, plain, error);
        }
        if (status == DIG_OK && plain->misfit < least) {
            least          = plain->misfit;
            air->effect[0] = other;
        }
    }
    if (status == DIG_OK) {
        status = dig_machine_side_apply(machine, air->effects, air->effect, measured);
    }
    return status == DIG_OK ? dig_trace_batch(w, digs, measured, plain, error) : status;
}

// Free air may show what the soil hides: an effect of the machine that a gravel of the table could
// stand in for is named, but the digs do not confirm it, and no more than even odds are claimed.
enum dig_status dig_trace_weigh_air(struct dig_machine_side *const machine, const size_t digs,
                                    const struct dig_measured      measured[],
                                    struct dig_trace_work *const   w,
                                    const struct dig_fitted *const plain)
{
    struct dig_measured *const alone = malloc(digs * sizeof *alone);
    if (alone == NULL) {
        return DIG_ENOMEM;
    }
    enum dig_status status = DIG_OK;
    memcpy(alone, measured, digs * sizeof *alone);
    for (size_t e = 0; e < w->air->effects && status == DIG_OK; e++) {
        struct dig_model_effect *const effect = &w->air->effect[e];

        status = dig_machine_side_apply(machine, 1, effect, alone);
        if (status == DIG_OK) {
            w->size[e] = dig_effect_size_of_machine(w->batch, plain, alone);
            effect->probability *= fmax(dig_effect_size_chance(w->size[e]), DIG_TRACE_UNCONFIRMED);
        }
    }
    free(alone);
    return status;
}

// The digs as they were measured.
static enum dig_status take_raw(struct dig_machine_side *const machine, const size_t digs,
                                struct dig_measured measured[], struct dig_trace_work *const w,
                                struct dig_error *const error)
{
    struct dig_fitted     raw;
    const enum dig_status status = dig_machine_side_apply(machine, 0, w->air->effect, measured);
    return status == DIG_OK ? dig_trace_batch(w, digs, measured, &raw, error) : status;
}

// Digs that are like the table's as they were measured, and like nothing once what free air names
// is taken off: what it names is not what is there.
enum dig_status dig_trace_doubt_air(struct dig_machine_side *const         machine,
                                    const struct dig_trace_settings *const settings,
                                    const size_t digs, struct dig_measured measured[],
                                    struct dig_trace_work *const w, struct dig_error *const error)
{
    const double                    level  = settings->false_alarm / 2.0;
    struct dig_whitened_digs *const batch  = malloc(sizeof *batch);
    struct dig_search *const        search = malloc(sizeof *search);
    enum dig_status                 status = DIG_ENOMEM;
    bool                            liker  = false;
    if (batch != NULL && search != NULL) {
        *batch  = *w->batch;
        *search = *w->search;
        status  = take_raw(machine, digs, measured, w, error);
    }
    if (status == DIG_OK) {
        status = dig_search_whether(w->batch, w->soil, level, settings->bootstraps, settings->seed,
                                    w->search);
        liker  = w->search->plain.squares < search->plain.squares - clearly_less;
    }
    if (status == DIG_OK && w->search->significant && liker) {
        status = take_raw(machine, digs, measured, w, error);
        if (status == DIG_OK) {
            status = dig_search_run(w->batch, w->soil, level, settings->bootstraps, settings->seed,
                                    w->search);
        }
    }
    if (status == DIG_OK && (!w->search->significant || liker)) {
        give_up_air(w->air);
    } else if (status == DIG_OK) {
        *w->batch  = *batch;
        *w->search = *search;
        status     = dig_machine_side_apply(machine, w->air->effects, w->air->effect, measured);
    }
    free(batch);
    free(search);
    return status;
}

enum dig_status dig_trace_air(struct dig_machine_side *const         machine,
                              const struct dig_trace_settings *const settings, const size_t digs,
                              struct dig_measured measured[], struct dig_trace_work *const w,
                              struct dig_fitted *const plain, struct dig_error *const error)
{
    assert(machine != NULL && settings != NULL && measured != NULL && w != NULL && plain != NULL);
    enum dig_status status = trace_machine(machine, settings, w, measured);
    if (status == DIG_OK && w->air->effects > 0) {
        status = choose_in_soil(machine, digs, measured, w, plain, error);
    }
    return status == DIG_OK ? dig_trace_weigh_air(machine, digs, measured, w, plain) : status;
}
