// What the soil shows and no effect of the soil explains may be the machine's: a linkage that is
// not the file's hardly shows in free air, where the drives push little, and in the digs at every
// push.
//
// Each effect of the machine, with the values that free air alone gives it, is taken off the digs.
// Free air's evidence and the digs' are of different samples, so their logarithms add up, and the
// bound that holds for free air's holds for both: under no effect at all the sum exceeds
// log(effects / level) with a chance of no more than the level.

#include "closed_loop/search/search_work.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Evidence is tempered, as the search's is.
static const double temper = 0.5;

// - 2 log likelihood of the digs by a plain gravel. What is taken off for the machine makes digs
// less certain (closed_loop/model/whitened_digs.h): a misfit in units that have grown is no
// likelihood.
static double surprise(const struct dig_whitened_digs *const batch,
                       const struct dig_fitted *const        plain)
{
    double sum = plain->misfit;
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t k = 0; k < batch->group[g].features; k++) {
            sum -= 2.0 * (double)batch->group[g].digs * log(batch->group[g].whiten[k][k]);
        }
    }
    return sum;
}

static struct dig_model_effect effect_of(const struct dig_candidate *const c)
{
    struct dig_model_effect effect = { .effect      = c->effect,
                                       .probability = 1.0,
                                       .parameters  = c->parameters };
    memcpy(effect.parameter, c->parameter, sizeof effect.parameter);
    return effect;
}

// The batch of the digs without what these effects add; *surprise2 as above.
static enum dig_status take_off(struct dig_machine_side *const machine, const size_t effects,
                                const struct dig_model_effect effect[], const size_t digs,
                                struct dig_measured measured[], struct dig_trace_work *const w,
                                double *const surprise2, struct dig_error *const error)
{
    struct dig_fitted plain;
    enum dig_status   status = dig_machine_side_apply(machine, effects, effect, measured);
    if (status == DIG_OK) {
        status = dig_trace_batch(w, digs, measured, &plain, error);
    }
    if (status == DIG_OK) {
        *surprise2 = surprise(w->batch, &plain);
    }
    return status;
}

// Free air's and the digs' evidence of each candidate against none; the best, and by how much it
// leads the next.
struct choice {
    size_t best;
    double evidence, lead;
};

static enum dig_status weigh(struct dig_machine_side *const machine, const size_t digs,
                             struct dig_measured measured[], struct dig_trace_work *const w,
                             struct choice *const choice, struct dig_error *const error)
{
    const struct dig_machine_finding *const air = w->air;
    double                                  none;
    struct choice                           made = { .evidence = -INFINITY, .lead = INFINITY };
    enum dig_status status = take_off(machine, 0, air->effect, digs, measured, w, &none, error);
    for (size_t i = 0; i < air->candidates && status == DIG_OK; i++) {
        const struct dig_model_effect effect = effect_of(&air->candidate[i]);
        double                        with   = INFINITY;
        status = take_off(machine, 1, &effect, digs, measured, w, &with, error);
        if (status == DIG_ENOMATCH || status == DIG_EINVAL) {
            status = DIG_OK; // a dig is not told with it: no candidate
        }
        const double evidence = air->candidate[i].log_evidence + 0.5 * (none - with);
        if (!isfinite(evidence)) {
            continue;
        }
        if (evidence > made.evidence) {
            made.lead     = evidence - made.evidence;
            made.evidence = evidence;
            made.best     = i;
        } else {
            made.lead = fmin(made.lead, made.evidence - evidence);
        }
    }
    *choice = made;
    return status;
}

// Not what free air has named already, and found wanting in the digs.
static bool is_new(const struct dig_machine_finding *const air, const enum dig_effect_id effect)
{
    bool is = true;
    for (size_t e = 0; e < air->effects; e++) {
        is = is && air->effect[e].effect != effect;
    }
    return is;
}

static bool is_decisive(const struct dig_machine_finding *const air,
                        const struct choice *const choice, const double level)
{
    // Two effects that free air names compete with none alone.
    return air->effects <= 1 && choice->lead >= DIG_SEARCH_TOLD_APART &&
           choice->evidence > log((double)air->candidates / level) &&
           is_new(air, air->candidate[choice->best].effect);
}

static void put_blame(struct dig_machine_finding *const air, const struct choice *const choice)
{
    const double least         = fmin(choice->lead, choice->evidence);
    air->effect[0]             = effect_of(&air->candidate[choice->best]);
    air->effect[0].probability = 1.0 / (1.0 + exp(-temper * least));
    air->effects               = 1;
    air->sets                  = 0;
    air->significant           = true;
    air->by_digs               = true;
    air->p_complete = fmin(air->p_complete, (double)air->candidates * exp(-choice->evidence));
}

static enum dig_status blame(struct dig_machine_side *const         machine,
                             const struct dig_trace_settings *const settings, const size_t digs,
                             struct dig_measured measured[], struct dig_trace_work *const w,
                             bool *const blamed, struct dig_error *const error)
{
    const double    level  = settings->false_alarm / 2.0;
    struct choice   choice = { .best = 0 };
    enum dig_status status = weigh(machine, digs, measured, w, &choice, error);
    if (status != DIG_OK || !is_decisive(w->air, &choice, level)) {
        return status;
    }
    const struct dig_model_effect effect = effect_of(&w->air->candidate[choice.best]);
    double                        ignored;
    status = take_off(machine, 1, &effect, digs, measured, w, &ignored, error);
    if (status == DIG_OK) {
        status = dig_search_whether(w->batch, w->soil, level, settings->bootstraps, settings->seed,
                                    w->search);
    }
    if (status == DIG_OK && !w->search->significant) {
        *blamed = true;
        put_blame(w->air, &choice);
        status = dig_trace_weigh_air(machine, digs, measured, w, &w->search->plain);
    }
    return status;
}

enum dig_status dig_trace_blame_machine(struct dig_machine_side *const         machine,
                                        const struct dig_trace_settings *const settings,
                                        const size_t digs, struct dig_measured measured[],
                                        struct dig_trace_work *const w, bool *const blamed,
                                        struct dig_error *const error)
{
    assert(machine != NULL && settings != NULL && measured != NULL && w != NULL && blamed != NULL);
    struct dig_whitened_digs *const batch  = malloc(sizeof *batch);
    struct dig_search *const        search = malloc(sizeof *search);
    enum dig_status                 status = DIG_ENOMEM;
    *blamed                                = false;
    if (batch != NULL && search != NULL) {
        *batch  = *w->batch;
        *search = *w->search;
        status  = blame(machine, settings, digs, measured, w, blamed, error);
    }
    if (status == DIG_OK && !*blamed) {
        *w->batch  = *batch;
        *w->search = *search;
        status     = dig_machine_side_apply(machine, w->air->effects, w->air->effect, measured);
    }
    free(batch);
    free(search);
    return status;
}
