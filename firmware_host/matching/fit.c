#include "firmware_host/matching/fit.h"

#include "estimator/approach/approach_slots.h"
#include "estimator/approach/observe_dig.h"
#include "estimator/track/inertia.h"
#include "firmware_host/matching/fit_publish.h"
#include "firmware_host/matching/fit_reload.h"
#include "firmware_host/matching/gravel_state.h"

#include <assert.h>
#include <math.h>
#include <time.h>
#include <unistd.h>

// The thread's pause between two turns without a finished dig: short beside a dig, and no load.
#define PAUSE_ns 20000000L

static const char *trajectory_name(const struct dig_fit *const fit, const int trajectory)
{
    return fit->matcher.set->trajectory[trajectory].name;
}

static bool identifies(const struct dig_fit *const fit, const int trajectory)
{
    return dig_config_identifies(fit->config, trajectory_name(fit, trajectory));
}

static void log_dig(struct dig_fit *const fit, const struct dig_observation *const dig,
                    const char *const what, const enum dig_status status)
{
    dig_fit_log(fit, "dig %u (%s): %s: %s", dig->dig_count, trajectory_name(fit, dig->trajectory),
                what, dig_status_str(status));
}

// The forecast a dig is compared with: at the depth and attack it was dug at.
static const struct dig_expected *forecast_for(struct dig_fit *const               fit,
                                               const struct dig_observation *const dig)
{
    const size_t t = (size_t)dig->trajectory;
    if (dig_approach_is_plain(&dig->approach) || !fit->track.valid) {
        return &fit->basis.forecast.expected[t];
    }
    dig_matcher_expect(&fit->matcher, &fit->track.match, t, &dig->approach, &fit->expected);
    return &fit->expected;
}

// A short dig gives a poor estimate; it must not replace a better one.
static bool is_too_short(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    const double measured = dig->last - dig->first;
    if (measured >= fit->config->match_least_path) {
        return false;
    }
    dig_fit_log(
        fit, "dig %u (%s): %sno match, %.0f %% of its path was measured, expected at least %.0f %%",
        dig->dig_count, trajectory_name(fit, dig->trajectory),
        dig->ending == DIG_ENDING_ABORTED ? "aborted, " : "", 100.0 * measured,
        100.0 * fit->config->match_least_path);
    return true;
}

static enum dig_status match_digs(struct dig_fit *const fit, const size_t digs,
                                  const struct dig_observation dig[], struct dig_match *const match,
                                  enum dig_status *const refined)
{
    return dig_matcher_match(&fit->matcher, digs, dig, fit->config->estimator.outside_floors,
                             fit->config->match_evaluations, match, refined);
}

// Matches a pool. Where no entry has all trajectories of the pool, the pool is cut to its youngest
// dig.
static enum dig_status match_pool(struct dig_fit *const fit, struct dig_pool *const pool,
                                  struct dig_match *const match, enum dig_status *const refined)
{
    const enum dig_status status = match_digs(fit, pool->digs, pool->dig, match, refined);
    if (status != DIG_ENOMATCH || pool->digs == 1) {
        return status;
    }
    pool->dig[0] = pool->dig[pool->digs - 1];
    pool->digs   = 1;
    return match_digs(fit, 1, pool->dig, match, refined);
}

// The machine whose inertia a recording holds; NULL: not known.
static const struct dig_machine *moved_machine(const struct dig_fit *const fit)
{
    return fit->basis.machine.corrects ? &fit->basis.machine.machine : fit->machine;
}

// The friction that a model tells of it; NULL: none.
static const struct dig_friction *stated_friction(const struct dig_fit *const fit)
{
    return fit->basis.machine.corrects ? fit->basis.machine.correction.friction : NULL;
}

// Tells the depth of an observed dig. False where the table does not go so deep.
static bool tell_depth(struct dig_fit *const fit, struct dig_observation *const dig)
{
    return dig_matcher_fit_depth(&fit->matcher, fit->config->estimator.path_limit_m, dig) == DIG_OK;
}

static void clear_provisional(struct dig_fit *const fit)
{
    fit->early->provisional = (struct dig_gravel_track){ .any = false };
}

static void match_dig(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    if (is_too_short(fit, dig)) {
        return;
    }
    struct dig_gravel_track gated = fit->track;
    const enum dig_gating   gating =
        dig_gravel_track_gate(&gated, dig, forecast_for(fit, dig), &fit->track_settings);
    if (gating == DIG_HELD) {
        fit->track = gated;
        dig_fit_publish_track(fit);
        return;
    }
    struct dig_pool pool = { .digs = 0 };
    if (gating == DIG_ACCEPTED) {
        pool = fit->pool;
    }
    dig_pool_add(&pool, dig);

    struct dig_match      match;
    enum dig_status       refined = DIG_OK;
    const enum dig_status status  = match_pool(fit, &pool, &match, &refined);
    if (status != DIG_OK) {
        log_dig(fit, dig,
                status == DIG_ENOMATCH ? "no match, the table holds no curve of this dig"
                                       : "no match",
                status);
        return;
    }
    if (refined != DIG_OK) {
        // The nearest entry stands: it is exact, only coarse.
        log_dig(fit, dig, "nearest entry only", refined);
    }
    fit->pool  = pool;
    fit->track = dig_gravel_track_make(fit->matcher.set, &match, dig, dig_input_now_ns(),
                                       &fit->track_settings);
    if (gating == DIG_ACCEPTED) {
        fit->track.drift = gated.drift;
    }
    clear_provisional(fit);
    dig_fit_publish_track(fit);
    dig_fit_save_state(fit);
    atomic_fetch_add(&fit->count.matches, 1);
}

// Matches the dig in progress alone; its interval is as wide as part of a path leaves it.
static void match_provisionally(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    struct dig_match match;
    enum dig_status  refined = DIG_OK;
    if (match_digs(fit, 1, dig, &match, &refined) != DIG_OK || refined != DIG_OK ||
        match.samples == 0) {
        return;
    }
    const struct dig_gravel_track_settings settings    = { .expires_s = DIG_EARLY_MATCH_s };
    struct dig_gravel_track *const         provisional = &fit->early->provisional;

    *provisional =
        dig_gravel_track_make(fit->matcher.set, &match, dig, dig_input_now_ns(), &settings);
    provisional->going_on = true;
    if (!fit->track.valid) {
        dig_fit_publish_basis(fit, provisional);
    }
    const struct dig_fit_result result = { .track = *provisional };
    (void)dig_ring_push(&fit->handoffs->results, &result);
}

// The dig in progress gives a provisional match and a forecast of itself as it is dug.
static void observe_early(struct dig_fit *const fit)
{
    struct dig_early_match *const     early = fit->early;
    const struct dig_curve_set *const set   = fit->matcher.set;
    struct dig_observation            dig;
    bool observed = dig_early_match_observe(early, set, fit->matcher.lambda, moved_machine(fit),
                                            stated_friction(fit), fit->config, &dig);
    if (observed && !tell_depth(fit, &dig)) {
        early->off_table_trajectory = dig.trajectory;
        observed                    = false;
    }
    observed = observed && dig.last - dig.first >= fit->config->match_early_path;
    if (observed && identifies(fit, dig.trajectory)) {
        match_provisionally(fit, &dig);
    }
    const struct dig_gravel_track *const track =
        fit->track.valid ? &fit->track : &early->provisional;
    if (observed && dig_approach_varies(set, (size_t)dig.trajectory)) {
        dig_fit_publish_basis_as_dug(fit, track, (size_t)dig.trajectory, &dig);
    } else if (!observed && early->off_table_trajectory >= 0) {
        dig_fit_publish_basis_as_dug(fit, track, (size_t)early->off_table_trajectory, NULL);
    }
}

// The dig is over and gave no match: its provisional match ends.
static void end_provisional(struct dig_fit *const fit)
{
    struct dig_fit_result result = { .track = fit->early->provisional };
    clear_provisional(fit);
    dig_fit_publish_track(fit);
    if (!fit->track.any) {
        dig_gravel_track_invalidate(&result.track, "the simple dig cannot be matched");
        (void)dig_ring_push(&fit->handoffs->results, &result);
    }
}

// Ends what the dig that was in progress left: its provisional match, the forecast adapted to it.
static void end_early(struct dig_fit *const fit)
{
    if (fit->early->live.digging) {
        return;
    }
    if (fit->early->provisional.any) {
        end_provisional(fit);
    }
    if (fit->basis_as_dug) {
        dig_fit_publish_basis(fit, &fit->track);
    }
}

static void count_aborted(struct dig_fit *const fit, const uint32_t dig_count, const int trajectory,
                          const double progress)
{
    dig_fit_log(fit, "dig %u (%s): aborted at %.0f %% of its path", dig_count,
                trajectory_name(fit, trajectory), 100.0 * progress);
    atomic_fetch_add(&fit->count.aborted, 1);
}

static void count_ending(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    if (dig->ending == DIG_ENDING_WHOLE) {
        atomic_fetch_add(&fit->count.whole, 1);
    } else if (dig->ending == DIG_ENDING_ABORTED) {
        count_aborted(fit, dig->dig_count, dig->trajectory, dig->last);
    }
}

// A dig that cannot be observed: aborted if it followed a trajectory at first, else unknown.
static void count_unobserved(struct dig_fit *const                fit,
                             const struct dig_recorded_dig *const recording)
{
    int    trajectory = -1;
    double progress   = 0.0;
    if (dig_recorded_dig_was_aborted(fit->matcher.set, &fit->config->estimator, recording,
                                     &trajectory, &progress)) {
        count_aborted(fit, recording->dig_count, trajectory, progress);
    } else {
        atomic_fetch_add(&fit->count.unknown, 1);
    }
}

void dig_fit_take(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    assert(fit != NULL && dig != NULL);
    if (dig->trajectory < 0 || (size_t)dig->trajectory >= fit->matcher.set->trajectories) {
        return;
    }
    count_ending(fit, dig);
    if (identifies(fit, dig->trajectory)) {
        match_dig(fit, dig);
    } else if (dig_gravel_track_compare(&fit->track, dig, forecast_for(fit, dig),
                                        &fit->track_settings)) {
        dig_fit_publish_track(fit);
    }
}

void dig_fit_restore(struct dig_fit *const fit)
{
    assert(fit != NULL);
    const char *const path  = fit->config->match_state.text;
    struct dig_error  error = { "" };
    fit->track.drift        = (double)NAN;
    if (path[0] == '\0' || access(path, F_OK) != 0) {
        return;
    }
    if (dig_gravel_state_read(path, fit->matcher.set, dig_input_now_ns(), &fit->track_settings,
                              &fit->track, &fit->pool, &error) == DIG_OK) {
        dig_fit_publish_track(fit);
    } else {
        dig_fit_log(fit, "%s", error.text);
    }
}

// Takes a finished dig, if there is one, and returns its memory to the tick.
static bool take_finished(struct dig_fit *const fit)
{
    struct dig_recorded_dig *recording = NULL;
    if (!dig_ring_pop(&fit->handoffs->digs, &recording)) {
        return false;
    }
    const struct dig_machine *const machine = moved_machine(fit);
    if (machine != NULL) {
        dig_inertia_take_off(machine, stated_friction(fit), fit->matcher.lambda,
                             &recording->window);
    }
    struct dig_observation dig;
    if (dig_recorded_dig_observe(fit->matcher.set, &fit->config->estimator, recording, &dig) ==
            DIG_OK &&
        tell_depth(fit, &dig)) {
        dig_fit_take(fit, &dig);
    } else {
        count_unobserved(fit, recording);
    }
    (void)dig_ring_push(&fit->handoffs->spares, &recording);
    atomic_fetch_add(&fit->count.seen, 1);
    return true;
}

bool dig_fit_once(struct dig_fit *const fit)
{
    assert(fit != NULL);
    atomic_store(&fit->busy, true);
    dig_matcher_retire(&fit->matcher);
    if (fit->matcher.retiring == NULL && atomic_exchange(&fit->reload, false)) {
        dig_fit_reload(fit);
    }
    if (dig_gravel_track_expire(&fit->track, dig_input_now_ns())) {
        dig_fit_publish_track(fit);
    }
    // Estimates first: once they show the end of a dig, its recording is in the queue.
    observe_early(fit);
    const bool taken = take_finished(fit);
    end_early(fit);
    atomic_store(&fit->busy, false);
    return taken;
}

void dig_fit_run(struct dig_fit *const fit)
{
    assert(fit != NULL);
    while (!atomic_load(fit->stop)) {
        if (!dig_fit_once(fit)) {
            const struct timespec pause = { .tv_nsec = PAUSE_ns };
            (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, NULL);
        }
    }
}
