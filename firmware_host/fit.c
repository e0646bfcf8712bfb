#include "firmware_host/fit.h"

#include <assert.h>
#include <stdio.h>
#include <time.h>

static void note(struct dig_fit *const fit, const struct dig_observation *const dig,
                 const char *const what, const enum dig_status status)
{
    struct dig_note note;
    (void)snprintf(note.text, sizeof note.text, "dig %u (%s): %s: %s", dig->dig_count,
                   fit->set->trajectory[dig->trajectory].name, what, dig_status_str(status));
    dig_latest_put(fit->notes, &note);
}

static void match_dig(struct dig_fit *const fit, const struct dig_observation *const dig)
{
    struct dig_match match;
    enum dig_status  status =
        dig_match_nearest(fit->set, dig, fit->config->estimator.outside_floors, &match);
    if (status != DIG_OK) {
        note(fit, dig,
             status == DIG_ENOMATCH ? "no match, the table holds no curve of this dig" : "no match",
             status);
        return;
    }
    status = dig_fit_refine(fit->set, dig, fit->config->match_evaluations, &match);
    if (status != DIG_OK) {
        // The nearest entry stands: it is exact, only coarse.
        note(fit, dig, "nearest entry only", status);
    }
    const struct dig_fit_result result = { .match      = match,
                                           .time_ns    = dig_input_now_ns(),
                                           .trajectory = dig->trajectory };
    dig_latest_put(fit->match, &match);
    (void)dig_ring_push(fit->results, &result);
    atomic_fetch_add(&fit->matches, 1);
}

bool dig_fit_once(struct dig_fit *const fit)
{
    assert(fit != NULL);
    struct dig_observation dig;
    atomic_store(&fit->busy, true);
    const bool any = dig_ring_pop(fit->digs, &dig);
    if (any && dig.trajectory >= 0 && (size_t)dig.trajectory < fit->set->trajectories &&
        dig_config_identifies(fit->config, fit->set->trajectory[dig.trajectory].name)) {
        match_dig(fit, &dig);
    }
    if (any) {
        atomic_fetch_add(&fit->seen, 1);
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
