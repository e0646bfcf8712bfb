#include "firmware_host/matching/fit.h"

#include "estimator/approach/approach_slots.h"
#include "estimator/approach/observe_dig.h"
#include "estimator/track/inertia_error.h"
#include "estimator/track/recorded_dig.h"
#include "firmware_host/config/load.h"
#include "tables/load.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static void note(struct dig_fit *const fit, const char *const text)
{
    struct dig_note note;
    (void)snprintf(note.text, sizeof note.text, "%.199s", text);
    dig_latest_put(fit->notes, &note);
}

static void note_dig(struct dig_fit *const fit, const struct dig_observation *const dig,
                     const char *const what, const enum dig_status status)
{
    char text[200];
    (void)snprintf(text, sizeof text, "dig %u (%s): %s: %s", dig->dig_count,
                   fit->set->trajectory[dig->trajectory].name, what, dig_status_str(status));
    note(fit, text);
}

// To the tick: what is predicted from.
static void offer(struct dig_fit *const fit, const struct dig_gravel_track *const k)
{
    struct dig_offer *const next = &fit->next;
    next->set                    = fit->set;
    next->generation             = fit->generation;
    next->known                  = k->valid;
    next->outside                = k->match.outside;
    next->dig_count              = k->match.dig_count;
    next->expires_ns             = k->any ? k->expires_ns : 0;
    dig_forecast_make(fit->set, fit->lambda, &k->match, &next->forecast);

    // Until the tick has the table, what belongs to it goes with it.
    const bool adopted = atomic_load(fit->tick_generation) == fit->generation;
    dig_latest_put(adopted ? fit->offer : fit->table, next);
    fit->dug = false;
}

// What was expected of a dig, made as it was.
static const struct dig_expected *expected_of(struct dig_fit *const               fit,
                                              const struct dig_observation *const dig)
{
    const size_t t = (size_t)dig->trajectory;
    if (dig_approach_is_plain(&dig->approach) || !fit->known.valid) {
        return &fit->next.forecast.along[t];
    }
    dig_matcher_expect(&fit->matcher, fit->set, fit->lambda, &fit->known.match, t, &dig->approach,
                       &fit->own);
    return &fit->own;
}

// To the tick, of the dig going on: what it resists with as it is dug, or that the table was not
// dug so (dig NULL).
static void offer_as_dug(struct dig_fit *const fit, const struct dig_gravel_track *const k,
                         const size_t trajectory, const struct dig_observation *const dig)
{
    struct dig_expected *const along = &fit->next.forecast.along[trajectory];
    if (!k->valid || (dig == NULL && along->off_table) ||
        atomic_load(fit->tick_generation) != fit->generation) {
        return;
    }
    if (dig != NULL) {
        dig_matcher_expect(&fit->matcher, fit->set, fit->lambda, &k->match, trajectory,
                           &dig->approach, along);
        dig_forecast_along_plain(fit->set, trajectory, &dig->approach, along);
    } else {
        along->valid     = false;
        along->off_table = true;
    }
    dig_latest_put(fit->offer, &fit->next);
    fit->dug = true;
}

// Tells tick and publisher what is known now.
static void tell(struct dig_fit *const fit)
{
    const struct dig_gravel_track *const k = &fit->known;
    offer(fit, k);
    if (k->any) {
        struct dig_fit_result result = { .known = *k };
        const int             hint = k->valid ? dig_gravel_track_hint(fit->set, &fit->next.forecast,
                                                                      fit->lambda, &result.hint_J_per_kg)
                                              : -1;
        if (hint >= 0) {
            (void)snprintf(result.hint_trajectory, sizeof result.hint_trajectory, "%s",
                           fit->set->trajectory[hint].name);
        }
        (void)dig_ring_push(fit->results, &result);
    }
}

static void keep(struct dig_fit *const fit)
{
    struct dig_error error = { "" };
    if (fit->config->match_state.text[0] != '\0' &&
        dig_gravel_track_write(fit->config->match_state.text, &fit->known, fit->set, &fit->pool,
                               &error) != DIG_OK) {
        note(fit, error.text);
    }
}

// Too little of a path: a gravel told from it would be wide of the truth, and take the place of a
// better one.
static bool is_too_short(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    const double path = dig->last - dig->first;
    if (path >= fit->config->match_least_path) {
        return false;
    }
    char text[200];
    (void)snprintf(
        text, sizeof text,
        "dig %u (%s): %sno match, %.0f %% of its path was measured, expected at least %.0f %%",
        dig->dig_count, fit->set->trajectory[dig->trajectory].name,
        dig->ending == DIG_ENDING_ABORTED ? "aborted, " : "", 100.0 * path,
        100.0 * fit->config->match_least_path);
    note(fit, text);
    return true;
}

// The entry nearest to a pool, or to its youngest dig alone where no entry has all of their
// trajectories.
static enum dig_status match_pool(struct dig_fit *const fit, struct dig_pool *const pool,
                                  struct dig_match *const match)
{
    const double          floors = fit->config->estimator.outside_floors;
    const enum dig_status status =
        dig_matcher_nearest(&fit->matcher, fit->set, pool->digs, pool->dig, floors, match);
    if (status != DIG_ENOMATCH || pool->digs == 1) {
        return status;
    }
    pool->dig[0] = pool->dig[pool->digs - 1];
    pool->digs   = 1;
    return dig_matcher_nearest(&fit->matcher, fit->set, 1, pool->dig, floors, match);
}

static void doubt(const struct dig_fit *const fit, struct dig_observation *const dig)
{
    if (fit->machine != NULL) {
        dig_inertia_error_forces(fit->machine, fit->lambda, dig);
    }
}

static void match_dig(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    if (is_too_short(fit, dig)) {
        return;
    }
    struct dig_gravel_track judged = fit->known;
    const enum dig_gating   kinship =
        dig_gravel_track_judge(&judged, dig, expected_of(fit, dig), &fit->known_settings);
    if (kinship == DIG_HELD) {
        fit->known = judged;
        tell(fit);
        return;
    }
    struct dig_pool pool = { .digs = 0 };
    if (kinship == DIG_ACCEPTED) {
        pool = fit->pool;
    }
    dig_pool_add(&pool, dig);

    struct dig_match match;
    enum dig_status  status = match_pool(fit, &pool, &match);
    if (status != DIG_OK) {
        note_dig(fit, dig,
                 status == DIG_ENOMATCH ? "no match, the table holds no curve of this dig"
                                        : "no match",
                 status);
        return;
    }
    status = dig_matcher_refine(&fit->matcher, fit->set, pool.digs, pool.dig,
                                fit->config->match_evaluations, &match);
    if (status != DIG_OK) {
        // The nearest entry stands: it is exact, only coarse.
        note_dig(fit, dig, "nearest entry only", status);
    }
    fit->pool  = pool;
    fit->hunch = (struct dig_gravel_track){ .any = false };
    fit->known =
        dig_gravel_track_of(fit->set, &match, dig, dig_input_now_ns(), &fit->known_settings);
    if (kinship == DIG_ACCEPTED) {
        fit->known.drift = judged.drift;
    }
    tell(fit);
    keep(fit);
    atomic_fetch_add(&fit->matches, 1);
}

// The dig going on, by itself: an interval as wide as part of a path leaves it, or nothing.
static void match_early(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    struct dig_match match;
    const double     floors = fit->config->estimator.outside_floors;
    if (dig_matcher_nearest(&fit->matcher, fit->set, 1, dig, floors, &match) != DIG_OK ||
        dig_matcher_refine(&fit->matcher, fit->set, 1, dig, fit->config->match_evaluations,
                           &match) != DIG_OK ||
        match.samples == 0) {
        return;
    }
    const struct dig_gravel_track_settings settings = { .expires_s = DIG_EARLY_MATCH_s };
    fit->hunch          = dig_gravel_track_of(fit->set, &match, dig, dig_input_now_ns(), &settings);
    fit->hunch.going_on = true;
    if (!fit->known.valid) {
        offer(fit, &fit->hunch);
    }
    const struct dig_fit_result result = { .known = fit->hunch };
    (void)dig_ring_push(fit->results, &result);
}

// The dig going on: what it tells of the gravel, and what it will resist with as it is dug.
static void look(struct dig_fit *const fit)
{
    struct dig_observation dig;
    if (dig_early_match_look(fit->early, fit->set, fit->lambda, fit->config, &dig)) {
        const size_t t = (size_t)dig.trajectory;
        doubt(fit, &dig);
        if (dig_config_identifies(fit->config, fit->set->trajectory[t].name)) {
            match_early(fit, &dig);
        }
        if (dig_approach_varies(fit->set, t)) {
            offer_as_dug(fit, fit->known.valid ? &fit->known : &fit->hunch, t, &dig);
        }
    } else if (fit->early->off >= 0) {
        offer_as_dug(fit, fit->known.valid ? &fit->known : &fit->hunch, (size_t)fit->early->off,
                     NULL);
    }
}

// The dig is over and was not matched: what it told is taken back.
static void end_hunch(struct dig_fit *const fit)
{
    struct dig_fit_result result = { .known = fit->hunch };
    fit->hunch                   = (struct dig_gravel_track){ .any = false };
    tell(fit);
    if (!fit->known.any) {
        dig_gravel_track_end(&result.known, "the simple dig cannot be matched");
        (void)dig_ring_push(fit->results, &result);
    }
}

static void tell_aborted(struct dig_fit *const fit, const uint32_t dig_count, const int trajectory,
                         const double at)
{
    char text[200];
    (void)snprintf(text, sizeof text, "dig %u (%s): aborted at %.0f %% of its path", dig_count,
                   fit->set->trajectory[trajectory].name, 100.0 * at);
    note(fit, text);
    atomic_fetch_add(&fit->aborted, 1);
}

// What an aborted dig has measured counts like any other's; that it was aborted is said.
static void tell_ending(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    if (dig->ending == DIG_ENDING_WHOLE) {
        atomic_fetch_add(&fit->whole, 1);
    } else if (dig->ending == DIG_ENDING_ABORTED) {
        tell_aborted(fit, dig->dig_count, dig->trajectory, dig->last);
    }
}

// A dig along none of the table's trajectories, unless it was along one for as long as it was dug.
static void tell_unknown(struct dig_fit *const fit, const struct dig_recorded_dig *const raw)
{
    int    trajectory = -1;
    double at         = 0.0;
    if (dig_recorded_dig_gave_up(fit->set, &fit->config->estimator, raw, &trajectory, &at)) {
        tell_aborted(fit, raw->dig_count, trajectory, at);
    } else {
        atomic_fetch_add(&fit->unknown, 1);
    }
}

void dig_fit_take(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    assert(fit != NULL && dig != NULL);
    if (dig->trajectory < 0 || (size_t)dig->trajectory >= fit->set->trajectories) {
        return;
    }
    tell_ending(fit, dig);
    if (dig_config_identifies(fit->config, fit->set->trajectory[dig->trajectory].name)) {
        match_dig(fit, dig);
    } else if (dig_gravel_track_watch(&fit->known, dig, expected_of(fit, dig),
                                      &fit->known_settings)) {
        tell(fit);
    }
}

// Judges a table as at start, with an estimator that is thrown away.
static enum dig_status check_table(const struct dig_fit *const       fit,
                                   const struct dig_curve_set *const set,
                                   struct dig_error *const           error)
{
    struct dig_estimator *const scratch = calloc(1, dig_estimator_size());
    if (scratch == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    const enum dig_status status =
        dig_estimator_init(scratch, fit->machine, set, &fit->config->estimator);
    free(scratch);
    return status == DIG_OK ? DIG_OK
                            : dig_error_set(error, status, "%s: table: %s", fit->config_path,
                                            dig_status_str(status));
}

// The same trajectories, and dug in several ways or not.
static bool has_same_digs(const struct dig_curve_set *const a, const struct dig_curve_set *const b)
{
    bool same = a->trajectories == b->trajectories;
    for (size_t t = 0; same && t < a->trajectories; t++) {
        same = strcmp(a->trajectory[t].name, b->trajectory[t].name) == 0 &&
               dig_approach_varies(a, t) == dig_approach_varies(b, t);
    }
    return same;
}

// The table and the model the configuration names now. All is checked before anything changes; a
// gravel that is known stays known where the new table holds it.
static void reload(struct dig_fit *const fit)
{
    struct dig_error      error = { "" };
    struct dig_curve_set *set   = NULL;
    struct dig_taken      taken;
    enum dig_status status = dig_load_table(fit->config_path, fit->machine, &set, &taken, &error);
    status                 = status == DIG_OK ? check_table(fit, set, &error) : status;
    if (status != DIG_OK) {
        char text[200];
        dig_curve_set_destroy(set);
        (void)snprintf(text, sizeof text, "reload refused, the table before stays: %.150s",
                       error.text[0] != '\0' ? error.text : dig_status_str(status));
        note(fit, text);
        atomic_fetch_add(&fit->reloads_refused, 1);
        return;
    }
    fit->retiring     = fit->set;
    fit->set          = set;
    fit->next.machine = taken;
    dig_matcher_take_up(&fit->matcher, set);
    fit->generation++;
    fit->lambda = fit->machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    if (fit->early != NULL) {
        dig_early_match_forget(fit->early, set);
    }
    if (!has_same_digs(fit->retiring, set)) {
        fit->pool.digs = 0;
    }
    if (!dig_gravel_track_move(&fit->known, set)) {
        fit->known.valid       = false;
        fit->known.match.valid = false;
        (void)snprintf(fit->known.wanted, sizeof fit->known.wanted,
                       "another table: dig a simple dig");
    }
    const struct dig_table_news news = { set, fit->generation };
    dig_latest_put(fit->tables, &news);
    tell(fit);
    note(fit, "");
    atomic_fetch_add(&fit->reloads, 1);
}

// Frees the table before once tick and publisher use the new one.
static void retire(struct dig_fit *const fit)
{
    if (fit->retiring != NULL && atomic_load(fit->tick_generation) == fit->generation &&
        atomic_load(fit->publish_generation) == fit->generation) {
        dig_curve_set_destroy(fit->retiring);
        fit->retiring = NULL;
    }
}

void dig_fit_restore(struct dig_fit *const fit)
{
    assert(fit != NULL);
    const char *const path  = fit->config->match_state.text;
    struct dig_error  error = { "" };
    fit->known.drift        = (double)NAN;
    if (path[0] == '\0' || access(path, F_OK) != 0) {
        return;
    }
    const enum dig_status status = dig_gravel_track_read(
        path, fit->set, dig_input_now_ns(), &fit->known_settings, &fit->known, &fit->pool, &error);
    if (status == DIG_OK) {
        tell(fit);
    } else {
        note(fit, error.text);
    }
}

bool dig_fit_once(struct dig_fit *const fit)
{
    assert(fit != NULL);
    struct dig_recorded_dig *raw = NULL;
    atomic_store(&fit->busy, true);
    retire(fit);
    if (fit->retiring == NULL && atomic_exchange(&fit->reload, false)) {
        reload(fit);
    }
    if (dig_gravel_track_age(&fit->known, dig_input_now_ns())) {
        tell(fit);
    }
    struct dig_observation dig;
    if (fit->early != NULL) {
        look(fit);
    }
    const bool any = dig_ring_pop(fit->digs, &raw);
    if (any) {
        if (dig_recorded_dig_observe(fit->set, &fit->config->estimator, raw, &dig) == DIG_OK) {
            doubt(fit, &dig);
            dig_fit_take(fit, &dig);
        } else {
            tell_unknown(fit, raw);
        }
        (void)dig_ring_push(fit->spares, &raw);
        atomic_fetch_add(&fit->seen, 1);
    }
    if (fit->early != NULL && fit->hunch.any && !fit->early->shadow.on) {
        end_hunch(fit);
    }
    if (fit->early != NULL && fit->dug && !fit->early->shadow.on) {
        offer(fit, &fit->known);
    }
    atomic_store(&fit->busy, false);
    return any;
}

void dig_fit_run(struct dig_fit *const fit)
{
    assert(fit != NULL);
    while (!atomic_load(fit->stop)) {
        if (!dig_fit_once(fit)) {
            const struct timespec pause = { .tv_nsec = 20000000L };
            (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, NULL);
        }
    }
}

void dig_fit_finish(struct dig_fit *const fit)
{
    assert(fit != NULL);
    dig_matcher_finish(&fit->matcher);
    dig_curve_set_destroy(fit->retiring);
    dig_curve_set_destroy(fit->set);
    fit->retiring = NULL;
    fit->set      = NULL;
}
