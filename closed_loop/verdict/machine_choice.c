// Chooses the effects of the machine by free air and the digs together.
//
// The answers of free air (closed_loop/machine/machine_side.h), none, and "something without a
// name" compete by one evidence: free air's, plus that of the digs fitted with what free air leaves
// open of the answer (closed_loop/verdict/machine_steps.c). Both are of different samples, so their
// logarithms add up. The digs' is that of the best of a plain gravel, one effect of the soil, and a
// soil without a name, so that neither side explains what is the other's. Under no effect the
// evidence ratio has mean 1, and exceeds answers / level with a chance of at most the level
// (Ville).

#include "closed_loop/accuracy/effect_size.h"
#include "closed_loop/recordings/features.h"
#include "closed_loop/search/search_work.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// What has no name, of the machine or of the soil, is the answer only where it leads by so much log
// evidence.
static const double unnamed_cost = DIG_SEARCH_TOLD_APART;

// Answers whose log evidence differs by less cannot be told apart.
static const double tie = 5.0;

// Odds are of tempered evidence, as the search's are.
static const double temper = 0.5;

struct choice {
    struct dig_machine_answer best;
    double                    z[DIG_STEPS_MAX]; // of its steps
    double                    evidence;
    double                    soil0;                   // of the digs as they were measured
    double                    of[DIG_MACHINE_ANSWERS]; // evidence of each
};

// The raw batch with what measured[].machine adds taken off: in the same units, so that the digs'
// evidence of one answer compares with that of another.
static void take_off_batch(const struct dig_batch *const raw, struct dig_batch *const batch)
{
    *batch = *raw;
    for (size_t i = 0; i < raw->digs; i++) {
        double feature[DIG_FEATURES];
        double added[DIG_FEATURES];
        dig_features_of(raw->measured[raw->dig[i].measured].machine, feature);
        dig_batch_whiten(&raw->group[raw->dig[i].group], feature, added);
        for (size_t k = 0; k < DIG_FEATURES; k++) {
            batch->dig[i].y[k] -= added[k];
        }
    }
    dig_batch_summarise(batch);
}

// The log evidence of the digs, of the best that the soil can be: *best.
static double soil_evidence(const struct dig_batch *const batch, struct dig_fitted *const best)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_hypothesis              single[DIG_RIVALS_MAX];
    struct dig_fitted                  fitted[DIG_RIVALS_MAX + 1];
    struct dig_fitted                  unnamed;
    struct dig_statistic               statistic;
    const size_t                       rivals = dig_search_rivals(batch, single);
    dig_null_simulation_fit(batch, &none, rivals, single, middle, DIG_FIT_THOROUGH, fitted,
                            &statistic);
    *best         = fitted[0];
    double misfit = fitted[0].misfit;
    dig_hypothesis_fit_unlisted(batch, &fitted[0], &unnamed);
    if (unnamed.misfit + 2.0 * unnamed_cost < misfit) {
        misfit = unnamed.misfit + 2.0 * unnamed_cost;
        *best  = unnamed;
    }
    for (size_t i = 0; i < rivals; i++) {
        const double penalty = 2.0 * dig_search_penalty(batch, dig_hypothesis_free(&single[i]));
        if (fitted[1 + i].misfit + penalty < misfit) {
            misfit = fitted[1 + i].misfit + penalty;
            *best  = fitted[1 + i];
        }
    }
    return -0.5 * misfit;
}

// The digs with what an answer adds taken off, its numbers open or not: the evidence of the digs,
// and of what is open the numbers. DIG_ENOMATCH: a dig is not told with it.
static enum dig_status weigh_digs(const struct dig_trace_work *const     w,
                                  const struct dig_machine_answer *const answer, const bool open,
                                  double *const evidence, double z[DIG_STEPS_MAX])
{
    struct dig_batch      batch;
    struct dig_steps      steps;
    struct dig_fitted     soil;
    const enum dig_status status =
        open ? dig_machine_steps_make(w, answer, &steps)
             : dig_trace_apply(w, answer->effects, answer->effect, answer->file);
    memset(z, 0, DIG_STEPS_MAX * sizeof z[0]);
    if (status == DIG_OK) {
        take_off_batch(w->batch, &batch);
        batch.steps = open ? &steps : NULL;
        *evidence   = soil_evidence(&batch, &soil);
        memcpy(z, soil.z, open ? DIG_STEPS_MAX * sizeof z[0] : 0);
    }
    return status;
}

// One answer: with free air's own values, or with what the digs make of what it leaves open. Where
// a dig is not told with it, or nothing is open of a wide one, it is none.
static enum dig_status weigh(const struct dig_trace_work *const w, const size_t from,
                             struct choice *const choice)
{
    struct dig_machine_answer answer = w->air->answer[from];
    double                    soil   = 0.0;
    double                    z[DIG_STEPS_MAX];
    const enum dig_status     status = weigh_digs(w, &answer, answer.wide, &soil, z);
    if (status == DIG_OK) {
        choice->of[from] = answer.log_evidence + soil - choice->soil0;
    }
    if (status == DIG_OK && choice->of[from] > choice->evidence) {
        dig_machine_steps_values(z, NULL, &answer);
        choice->evidence = choice->of[from];
        choice->best     = answer;
        memcpy(choice->z, z, sizeof choice->z);
    }
    return status == DIG_ENOMATCH ? DIG_OK : status;
}

// Single effects that free air and the digs cannot tell from the one chosen.
static void write_set(const struct choice *const choice, struct dig_machine_finding *const air)
{
    struct dig_candidate_set *const set = &air->set[0];
    set->effects                        = 1;
    set->effect[0]                      = choice->best.effect[0].effect;
    for (size_t i = 0; i < air->answers; i++) {
        const enum dig_effect_id effect = air->answer[i].effect[0].effect;
        if (air->answer[i].effects == 1 && choice->of[i] > choice->evidence - tie &&
            dig_effect_place(set->effects, set->effect, effect) == set->effects) {
            set->effect[set->effects++] = effect;
        }
    }
    air->sets = set->effects > 1 ? 1 : 0;
}

static double odds(const double log_evidence)
{
    return 1.0 / (1.0 + exp(-temper * log_evidence));
}

// By how much the answer leads all that do not hold its effect, and none.
static double lead_of(const struct choice *const              choice,
                      const struct dig_machine_finding *const air)
{
    double lead = choice->evidence;
    for (size_t i = 0; i < air->answers; i++) {
        bool same = false;
        for (size_t e = 0; e < air->answer[i].effects; e++) {
            same = same || air->answer[i].effect[e].effect == choice->best.effect[0].effect;
        }
        lead = same ? lead : fmin(lead, choice->evidence - choice->of[i]);
    }
    return lead;
}

// Whether free air alone tells what was chosen, by any prior.
static bool told_by_air(const struct choice *const              choice,
                        const struct dig_machine_finding *const air, const double least)
{
    bool told = false;
    for (size_t i = 0; i < air->answers; i++) {
        const struct dig_machine_answer *const answer = &air->answer[i];
        told = told || (answer->effects == choice->best.effects &&
                        answer->effect[0].effect == choice->best.effect[0].effect &&
                        answer->log_evidence >= least);
    }
    return told;
}

static void write_choice(const struct choice *const choice, const double least,
                         struct dig_machine_finding *const air)
{
    const struct dig_machine_answer *const best = &choice->best;
    air->by_digs                                = !told_by_air(choice, air, least);
    // How often free air's own choice came out of digs drawn anew; else the odds of the lead.
    const double inclusion = air->effects == 1 && best->effects == 1 && !air->by_digs
                                 ? air->effect[0].probability
                                 : odds(lead_of(choice, air));
    for (size_t e = 0; e < best->effects; e++) {
        air->effect[e] = best->effect[e];
        if (best->effects == 1) {
            air->effect[e].probability = inclusion;
        }
    }
    if (best->effects == 1) {
        write_set(choice, air);
    }
    air->effects     = best->effects;
    air->significant = true;
    air->unexplained = false;
    air->unlike.is   = false;
    air->p_complete =
        fmin(air->p_complete, (double)air->candidates * exp(-fmax(choice->evidence, 0.0)));
}

// What is open of the choice, about the values it was given.
static void leave_open(const struct choice *const choice, struct dig_trace_open *const open)
{
    size_t n     = 0;
    open->answer = choice->best;
    for (size_t e = 0; e < choice->best.effects; e++) {
        for (size_t p = 0; p < choice->best.effect[e].parameters; p++) {
            open->answer.value[n++] = choice->best.effect[e].parameter[p].value;
        }
    }
    memcpy(&open->answer.value[n], choice->best.file, sizeof choice->best.file);
}

// Nothing has a name; significant: whether anything is there all the same.
static void write_none(const bool significant, struct dig_machine_finding *const air)
{
    air->effects     = 0;
    air->sets        = 0;
    air->significant = significant;
    air->unexplained = significant;
}

static enum dig_status choose(struct dig_trace_work *const w, struct choice *const choice)
{
    struct dig_machine_finding *const air   = w->air;
    const double                      level = w->settings->false_alarm / 2.0;
    const double                      least = log((double)air->candidates / level);
    // Evidence of a file that is wrong by more than it allows: the digs as they were measured have
    // it taken off.
    double unnamed                 = air->unlike.is ? air->unlike.log_evidence : (double)-INFINITY;
    struct dig_machine_answer none = air->none;
    double                    z[DIG_STEPS_MAX];
    choice->evidence       = -INFINITY;
    enum dig_status status = weigh_digs(w, &none, none.numbers > 0, &choice->soil0, z);
    dig_machine_steps_values(z, NULL, &none);
    // All that an answer could explain of the digs.
    const double left = 0.5 * (w->before.squares - dig_batch_about(w->batch));
    for (size_t i = 0; i < air->answers; i++) {
        choice->of[i] = -INFINITY;
    }
    for (size_t i = 0; i < air->answers && status == DIG_OK; i++) {
        unnamed = fmax(unnamed, air->answer[i].log_evidence - unnamed_cost);
        // Not one that could explain all the digs leave and still be no answer, or none of the
        // best.
        const double most = air->answer[i].log_evidence + left;
        if (most >= fmax(least, choice->evidence - tie)) {
            status = weigh(w, i, choice);
        }
    }
    if (choice->evidence >= fmax(least, unnamed)) {
        write_choice(choice, least, air);
    } else {
        write_none(air->unlike.is || unnamed >= least, air);
        choice->best = none;
        memcpy(choice->z, z, sizeof choice->z);
    }
    leave_open(choice, w->open);
    return status;
}

// An effect of the machine that a gravel of the table could stand in for is named, but the digs do
// not confirm it, and no more than even odds are claimed.
static enum dig_status weigh_in_soil(struct dig_trace_work *const   w,
                                     const struct dig_fitted *const plain)
{
    double          machine[DIG_MEASURED_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    enum dig_status status = DIG_OK;
    for (size_t e = 0; e < w->air->effects && status == DIG_OK; e++) {
        struct dig_model_effect *const effect = &w->air->effect[e];

        status = dig_machine_side_apply(w->machine, 1, effect, NULL, DIG_APPLY_TO_FITTED,
                                        w->measured, machine);
        if (status == DIG_OK) {
            w->size[e] = dig_effect_size_of_machine(
                w->batch, plain, (const double(*)[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])machine);
            effect->probability *= fmax(dig_effect_size_chance(w->size[e]), DIG_TRACE_UNCONFIRMED);
        }
    }
    return status;
}

enum dig_status dig_trace_machine(struct dig_trace_work *const w, struct dig_error *const error)
{
    assert(w != NULL && w->machine != NULL);
    struct choice                choice = { .evidence = 0.0 };
    struct dig_trace_open *const open   = w->open;
    struct dig_fitted            plain;
    enum dig_status status = dig_machine_side_trace(w->machine, w->settings->false_alarm / 2.0,
                                                    w->settings->seed, w->air);
    if (status == DIG_OK && w->air->answers > 0) {
        status = choose(w, &choice);
    }
    if (status == DIG_OK && open->answer.numbers > 0) {
        status = dig_machine_steps_make(w, &open->answer, &open->steps);
    } else if (status == DIG_OK) {
        status = dig_trace_apply(w, w->air->effects, w->air->effect, open->answer.file);
    }
    if (status == DIG_ENOMATCH) { // a holdout is not told with what the digs made of it
        write_none(true, w->air);
        open->answer.numbers = 0;
        status               = dig_trace_apply(w, 0, NULL, NULL);
    }
    if (status == DIG_OK) {
        status = dig_trace_batch(w, &plain, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    if (open->answer.numbers > 0) {
        for (size_t k = 0; k < open->steps.steps; k++) {
            open->steps.middle[k] = -choice.z[k];
        }
        w->batch->steps = &open->steps;
    }
    return weigh_in_soil(w, &plain);
}

enum dig_status dig_trace_settle_machine(struct dig_trace_work *const w, const double covariance[])
{
    assert(w != NULL);
    struct dig_machine_answer answer = w->open->answer;
    if (w->batch->steps == NULL) {
        return DIG_OK;
    }
    dig_machine_steps_values(w->search->chosen.z, covariance, &answer);
    const enum dig_status status = dig_trace_apply(w, answer.effects, answer.effect, answer.file);
    if (status == DIG_ENOMATCH) { // a holdout is told with the values that were chosen alone
        memset(w->search->chosen.z, 0, sizeof w->search->chosen.z);
        return dig_trace_apply(w, w->air->effects, w->air->effect, w->open->answer.file);
    }
    for (size_t e = 0; e < answer.effects; e++) {
        memcpy(w->air->effect[e].parameter, answer.effect[e].parameter,
               sizeof answer.effect[e].parameter);
    }
    return status;
}
