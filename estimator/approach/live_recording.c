#include "estimator/approach/live_recording.h"

#include "estimator/approach/observe_dig.h"

#include <assert.h>
#include <string.h>

void dig_live_recording_forget(struct dig_live_recording *const  shadow,
                               const struct dig_curve_set *const set)
{
    assert(shadow != NULL && set != NULL);
    shadow->on = false;
    dig_recorded_dig_forget(&shadow->raw, set);
}

void dig_live_recording_take(struct dig_live_recording *const  shadow,
                             const struct dig_curve_set *const set, const double lambda,
                             const struct dig_estimate *const estimate)
{
    assert(shadow != NULL && set != NULL && estimate != NULL);
    const struct dig_estimate *const e = estimate;
    if (!e->wrench.moment_valid) {
        return;
    }
    const struct dig_path_point point =
        dig_recorded_dig_point(set, lambda, e->pin_X_m, e->pin_Z_m, e->phi_rad);
    dig_recorded_dig_add(&shadow->raw, lambda, e->time_ns, &e->wrench, 0.0, &point);

    const bool in_soil = e->phase == DIG_PHASE_CONTACT || e->phase == DIG_PHASE_DIG;
    if (!shadow->on && e->phase == DIG_PHASE_CONTACT) {
        shadow->on   = true;
        shadow->digs = e->dig_count;
        dig_recorded_dig_touch(&shadow->raw, &point);
    } else if (shadow->on && (e->phase == DIG_PHASE_AIR || e->dig_count != shadow->digs)) {
        dig_live_recording_forget(shadow, set);
    }
    if (shadow->on) {
        (void)dig_path_add(&shadow->raw.path, &point, in_soil);
    }
}

enum dig_status dig_live_recording_observe(const struct dig_curve_set *const          set,
                                           const struct dig_estimator_settings *const settings,
                                           const struct dig_live_recording *const     shadow,
                                           struct dig_recorded_dig *const             scratch,
                                           struct dig_observation *const              observation)
{
    assert(set != NULL && settings != NULL && shadow != NULL && scratch != NULL);
    if (!shadow->on) {
        return DIG_ENOMATCH;
    }
    const struct dig_window *const window = &shadow->raw.window;
    scratch->dig_count                    = shadow->digs + 1;
    scratch->path                         = shadow->raw.path;
    scratch->window.open                  = true;
    scratch->window.goes_on               = true;
    scratch->window.count                 = window->count;
    scratch->window.stride                = window->stride;
    memcpy(scratch->window.sample, window->sample, window->count * sizeof window->sample[0]);
    return dig_recorded_dig_observe(set, settings, scratch, observation);
}
