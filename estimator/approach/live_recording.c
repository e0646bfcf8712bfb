#include "estimator/approach/live_recording.h"

#include "estimator/approach/observe_dig.h"
#include "estimator/track/inertia.h"

#include <assert.h>
#include <string.h>

void dig_live_recording_clear(struct dig_live_recording *const  live,
                              const struct dig_curve_set *const set)
{
    assert(live != NULL && set != NULL);
    live->digging = false;
    dig_recorded_dig_clear(&live->recording, set);
}

void dig_live_recording_add(struct dig_live_recording *const  live,
                            const struct dig_curve_set *const set, const double lambda,
                            const struct dig_estimate *const estimate)
{
    assert(live != NULL && set != NULL && estimate != NULL);
    const struct dig_estimate *const e = estimate;
    if (!e->wrench.moment_valid) {
        return;
    }
    const struct dig_path_point point =
        dig_recorded_dig_point(set, lambda, e->pin_X_m, e->pin_Z_m, e->phi_rad);
    dig_recorded_dig_add(&live->recording, set, lambda, e->time_ns, &e->wrench, 0.0, e->pitch_rad,
                         &point, e->joint_rad);

    const bool in_soil = e->phase == DIG_PHASE_CONTACT || e->phase == DIG_PHASE_DIG;
    if (!live->digging && e->phase == DIG_PHASE_CONTACT) {
        live->digging   = true;
        live->dig_count = e->dig_count;
        dig_recorded_dig_contact(&live->recording, &point);
    } else if (live->digging && (e->phase == DIG_PHASE_AIR || e->dig_count != live->dig_count)) {
        dig_live_recording_clear(live, set);
    }
    if (live->digging) {
        dig_recorded_dig_follow(&live->recording, &point, in_soil);
    }
}

enum dig_status dig_live_recording_observe(const struct dig_curve_set *const          set,
                                           const struct dig_estimator_settings *const settings,
                                           const struct dig_machine *const            machine,
                                           const struct dig_friction                  stated[],
                                           const struct dig_live_recording *const     live,
                                           struct dig_recorded_dig *const             scratch,
                                           struct dig_observation *const              observation)
{
    assert(set != NULL && settings != NULL && live != NULL && scratch != NULL);
    if (!live->digging) {
        return DIG_ENOMATCH;
    }
    const struct dig_window *const window = &live->recording.window;
    scratch->dig_count                    = live->dig_count + 1;
    scratch->path                         = live->recording.path;
    scratch->contact_s                    = live->recording.contact_s;
    scratch->soil_s                       = live->recording.soil_s;
    scratch->pitch_rad                    = live->recording.pitch_rad;
    scratch->pitched                      = live->recording.pitched;
    scratch->window.open                  = true;
    scratch->window.in_progress           = true;
    scratch->window.count                 = window->count;
    scratch->window.stride                = window->stride;
    memcpy(scratch->window.sample, window->sample, window->count * sizeof window->sample[0]);
    if (machine != NULL) {
        dig_inertia_take_off(machine, stated,
                             machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m,
                             &scratch->window);
    }
    return dig_recorded_dig_observe(set, settings, scratch, observation);
}
