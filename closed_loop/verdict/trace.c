#include "closed_loop/verdict/trace.h"

#include "closed_loop/accuracy/effect_size.h"
#include "closed_loop/accuracy/judge.h"
#include "closed_loop/fit/posterior.h"
#include "closed_loop/recordings/lateness.h"
#include "closed_loop/verdict/residuals.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A prediction is changed where this chance that the next dig comes out worse for it is not
// exceeded: a change 1.7 times as large as what one dig scatters by in its direction. On the
// split for development .25 makes the holdout worse in 4 of 204 campaigns of one effect, .2 in 2,
// and .15 costs what the effect is worth: 5 of 77 more than 1.15 times from the oracle, not 2.
static const double most_chance_of_worse = 0.2;

struct dig_trace_settings dig_trace_settings_default(void)
{
    return (struct dig_trace_settings){ .false_alarm = 0.01, .seed = 1, .bootstraps = 200 };
}

void dig_trace_finish(struct dig_trace *const trace)
{
    if (trace != NULL) {
        free(trace->judged.curves);
        free(trace->residuals);
        memset(trace, 0, sizeof *trace);
    }
}

static enum dig_status prepare(struct dig_trace_work *const w, struct dig_error *const error)
{
    if (dig_response_surface_fit(w->set, w->surface) != DIG_OK) {
        return dig_error_set(error, DIG_EINVAL,
                             "the table holds too few gravels to trace with, expected %d or more",
                             DIG_RESPONSE_SURFACE_LEAST);
    }
    enum dig_status status = w->table != NULL
                                 ? dig_scatter_measure(w->table, w->surface, &w->scatter, error)
                                 : dig_scatter_pool(w->surface, 0, NULL, &w->scatter);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_soil_create(w->surface, w->effects, w->scatter, &w->soil);
    return status == DIG_EINVAL
               ? dig_error_set(error, status,
                               "the table of effects is of another scene, expected "
                               "that of the table")
               : status;
}

static enum dig_status check_digs(struct dig_trace_work *const w, struct dig_error *const error)
{
    size_t fits = 0;
    if (w->digs > DIG_MEASURED_MAX) {
        return dig_error_set(error, DIG_EINVAL, "%zu digs, expected at most %d", w->digs,
                             DIG_MEASURED_MAX);
    }
    for (size_t i = 0; i < w->digs; i++) {
        const int t = w->measured[i].trajectory;
        if (t < 0 || (size_t)t >= w->set->trajectories || !w->surface->known[t]) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: along a trajectory whose curves the table lacks",
                                 w->measured[i].name);
        }
        w->holdout[i] = w->measured[i].use == DIG_USE_HOLDOUT;
        w->fit[i]     = !w->holdout[i];
        fits += w->fit[i] ? 1 : 0;
    }
    dig_lateness_share(w->digs, w->measured, w->fit);
    return fits >= 2 ? DIG_OK
                     : dig_error_set(error, DIG_EINVAL,
                                     "%zu identify and fit recordings, expected two or more: one "
                                     "dig alone cannot tell a gravel from an effect",
                                     fits);
}

static void fill_decision(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    const struct dig_machine_finding *const  air     = w->air;
    const struct dig_search *const           s       = w->search;
    const struct dig_response_surface *const surface = w->surface;
    const bool                               machine = w->machine != NULL;
    trace->false_alarm                               = w->settings->false_alarm;
    trace->no_air                                    = air->no_air;
    trace->beyond                                    = s->significant && s->outside;
    trace->significant = air->significant || (s->significant && !s->outside);
    trace->p_complete =
        machine ? fmin(1.0, 2.0 * fmin(air->p_complete, s->p_complete)) : s->p_complete;
    dig_trace_fill_residuals(w, trace->residual);
    trace->residual[DIG_PART_AIR] = machine ? air->residual_air : (double)NAN;
    for (size_t i = 0; i < air->candidates && trace->candidates < DIG_TRACE_CANDIDATES_MAX; i++) {
        trace->candidate[trace->candidates++] = air->candidate[i];
    }
    trace->gravel_before = dig_response_surface_gravel(surface, w->before.number);
    trace->low_before    = dig_response_surface_gravel(surface, w->before.low);
    trace->high_before   = dig_response_surface_gravel(surface, w->before.high);
    trace->gravel        = dig_response_surface_gravel(surface, s->chosen.number);
    trace->low           = dig_response_surface_gravel(surface, s->chosen.low);
    trace->high          = dig_response_surface_gravel(surface, s->chosen.high);
}

// Whether nothing was found but what the machine's file has wrong within its tolerance, which tells
// the gravel and is no effect.
static bool is_as_filed(const struct dig_trace_work *const w)
{
    bool as_filed = true;
    for (size_t f = 0; f < DIG_FILE_ERRORS; f++) {
        as_filed = as_filed && !(fabs(w->open->answer.file[f]) > 0.0);
    }
    return w->air->effects == 0 && !w->search->significant && !as_filed;
}

// A change is named, but not made, that is likely to make the next dig's error worse, or that has
// made it worse already: forces may ask for what the moment does not.
static void drop_what_is_not_worth_it(const struct dig_trace_work *const w,
                                      struct dig_trace *const            trace)
{
    trace->applied =
        w->confirmed && !is_as_filed(w) && dig_decision_brings_nearer(&trace->judged, w->fit) &&
        dig_decision_chance_of_worse(&trace->judged, w->scatter) <= most_chance_of_worse;
    for (size_t i = 0; i < w->digs && !trace->applied; i++) {
        trace->judged.curves[i].after = trace->judged.curves[i].before;
    }
}

static void fill_errors(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    for (size_t i = 0; i < w->digs; i++) {
        trace->holdouts += w->holdout[i] ? 1 : 0;
    }
    trace->before      = dig_judge_error(&trace->judged, w->holdout, false, w->settings->seed);
    trace->after       = dig_judge_error(&trace->judged, w->holdout, true, w->settings->seed);
    trace->noise_floor = dig_judge_floor(&trace->judged, trace->holdouts > 0 ? w->holdout : w->fit);
}

static enum dig_status report(const struct dig_trace_work *const w, struct dig_trace *const trace,
                              struct dig_error *const error)
{
    trace->judged =
        (struct dig_judged){ .set      = w->set,
                             .digs     = w->digs,
                             .measured = w->measured,
                             .curves   = calloc(w->digs, sizeof(struct dig_trace_curves)) };
    trace->residuals = malloc(sizeof *trace->residuals);
    if (trace->judged.curves == NULL || trace->residuals == NULL) {
        return DIG_ENOMEM;
    }
    fill_decision(w, trace);
    dig_trace_fill_verdict(w, trace);
    trace->significant = trace->significant || trace->effects > 0;
    dig_trace_fill_candidates(w, trace);
    dig_trace_fill_curves(w, &trace->unlisted, trace->judged.curves);
    drop_what_is_not_worth_it(w, trace);
    fill_errors(w, trace);
    dig_residuals_make(w, trace->judged.curves, trace->residuals);
    const enum dig_status status = dig_tell_apart(w, trace);
    return status == DIG_OK ? dig_trace_explain(w, trace, error) : status;
}

// Whether ground that depends on the rate feels the speed of the tooth or the pace of the dig: what
// the digs are liker to, refitted with either.
static void choose_rate(struct dig_trace_work *const w)
{
    static const struct dig_hypothesis rate = { .effects = 1,
                                                .effect  = { DIG_EFFECT_RATE_DEPENDENCE } };
    assert(w->soil != NULL);
    if (!dig_hypothesis_possible(w->batch, DIG_EFFECT_RATE_DEPENDENCE)) {
        return;
    }
    double misfit[2];
    for (int along = 0; along < 2; along++) {
        struct dig_fitted fitted;
        double            start[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
        memcpy(start, w->before.number, DIG_AXES * sizeof start[0]);
        w->soil->along = (double)along;
        dig_hypothesis_fit(w->batch, &rate, start, DIG_FIT_THOROUGH, &fitted);
        misfit[along] = fitted.misfit;
    }
    w->soil->along = misfit[1] < misfit[0] ? 1.0 : 0.0;
}

// An effect of the soil that another gravel of the table could stand in for: see
// dig_trace_weigh_air().
// So with what has no name, of the soil or of the machine.
static void weigh_soil(const struct dig_trace_work *const w)
{
    struct dig_search *const s    = w->search;
    const double             left = dig_effect_size_left(w->batch, &s->plain);
    s->unnamed                    = fmax(dig_effect_size_chance(left), DIG_TRACE_UNCONFIRMED);
    for (size_t e = 0; s->significant && !s->unlisted && e < s->chosen.hypothesis.effects; e++) {
        const double size = dig_effect_size_of_soil(w->batch, &s->chosen, e, s->plain.noise);
        s->probability[e] *= fmax(dig_effect_size_chance(size), DIG_TRACE_UNCONFIRMED);
    }
}

// Of what is open of the answer alone: n of the numbers.
static void keep_first(const size_t n, const size_t numbers, double covariance[])
{
    for (size_t i = 0; i < n; i++) {
        memmove(covariance + i * n, covariance + i * numbers, n * sizeof covariance[0]);
    }
}

// How well what was found is known (covariance: of what is open of the machine), and what cannot be
// told from it. Of what has lost, nothing is said. Effects of the machine that were not chosen are
// open here, as far as free air does not exclude them.
static enum dig_status find_intervals(const struct dig_trace_work *const w, double covariance[])
{
    struct dig_search *const              s      = w->search;
    const struct dig_candidate_set *const alike  = &s->alike;
    struct dig_trace_open *const          open   = w->open;
    const uint64_t                        seed   = w->settings->seed;
    enum dig_status                       status = DIG_OK;
    if (w->batch->steps != NULL) {
        status = dig_machine_others_make(w, &open->answer, &open->steps);
    }
    dig_posterior_intervals(w->batch, seed, &s->chosen, covariance);
    for (size_t i = 0; i < s->rivals; i++) {
        struct dig_fitted *const f      = &s->rival[i].fitted;
        const enum dig_effect_id effect = f->hypothesis.effect[0];
        if (dig_effect_place(alike->effects, alike->effect, effect) < alike->effects) {
            dig_posterior_intervals(w->batch, seed, f, NULL);
            continue;
        }
        for (size_t j = 0; j < DIG_HYPOTHESIS_NUMBERS; j++) {
            f->low[j]  = (double)NAN;
            f->high[j] = (double)NAN;
        }
    }
    keep_first(open->answer.numbers, open->steps.steps, covariance);
    open->steps.steps = open->answer.numbers;
    return status;
}

static enum dig_status run(struct dig_trace_work *const w, struct dig_trace *const trace,
                           struct dig_error *const error)
{
    const struct dig_trace_settings *const settings = w->settings;

    double          level  = settings->false_alarm;
    enum dig_status status = prepare(w, error);
    if (status == DIG_OK) {
        status = check_digs(w, error);
    }
    if (status == DIG_OK && w->machine != NULL) {
        status = dig_machine_side_tell_noise(w->machine, w->measured);
    }
    if (status == DIG_OK) {
        status = dig_trace_batch(w, &w->before, error);
    }
    if (status == DIG_OK && w->machine == NULL) {
        status = dig_trace_tell_noise(w, &w->before);
    }
    if (status != DIG_OK) {
        return status;
    }
    dig_posterior_intervals(w->batch, settings->seed, &w->before, NULL);
    if (w->machine != NULL) {
        level /= 2.0;
        choose_rate(w);
        status = dig_trace_machine(w, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    double covariance[DIG_STEPS_MAX * DIG_STEPS_MAX];
    choose_rate(w);
    dig_search_run(w->batch, level, settings->bootstraps, settings->seed, w->search);
    dig_trace_doubt_soil(w);
    status = find_intervals(w, covariance);
    if (status == DIG_OK) {
        status = dig_trace_settle_machine(w, covariance);
    }
    if (status != DIG_OK) {
        return status;
    }
    weigh_soil(w);
    dig_trace_confirm_without_air(w);
    dig_steps_settle(w->batch, w->search->chosen.z);
    // Nothing was found that is corrected: nothing changes.
    if (w->air->effects == 0 && !w->search->significant && !is_as_filed(w)) {
        w->search->chosen = w->before;
    }
    return report(w, trace, error);
}

// What a trace works in, but for what has its size from the table.
struct room {
    struct dig_response_surface surface;
    struct dig_batch            batch;
    struct dig_search           search;
    struct dig_machine_finding  air;
    struct dig_trace_open       open;
    struct dig_trace            made;
};

enum dig_status dig_trace_run(const struct dig_curve_set *const set, const char *const table,
                              const struct dig_entry_set *const      effects,
                              const struct dig_trace_settings *const settings,
                              struct dig_machine_side *const machine, const size_t digs,
                              struct dig_measured measured[], struct dig_trace *const trace,
                              struct dig_error *const error)
{
    assert(set != NULL && settings != NULL && measured != NULL && trace != NULL);
    struct room *const room = calloc(1, sizeof *room);
    if (room == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    struct dig_error      why    = { "" };
    struct dig_trace_work w      = { .set      = set,
                                     .table    = table,
                                     .effects  = effects,
                                     .settings = settings,
                                     .machine  = machine,
                                     .digs     = digs,
                                     .measured = measured,
                                     .surface  = &room->surface,
                                     .batch    = &room->batch,
                                     .search   = &room->search,
                                     .air      = &room->air,
                                     .open     = &room->open };
    const enum dig_status status = run(&w, &room->made, &why);
    if (status == DIG_OK) {
        *trace = room->made;
    } else {
        dig_trace_finish(&room->made);
        (void)dig_error_set(error, status, "%s",
                            why.text[0] != '\0' ? why.text : dig_status_str(status));
    }
    dig_scatter_destroy(w.scatter);
    free(w.soil);
    free(room);
    return status;
}
