#include "closed_loop/machine_digs/observe_machine.h"

#include "closed_loop/machine_digs/recording_faults.h"
#include "estimator/approach/approach_error.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/observe_dig.h"
#include "estimator/estimator.h"
#include "estimator/match/depth.h"
#include "estimator/track/inertia.h"

#include <assert.h>
#include <stdlib.h>

static enum dig_status append(struct dig_observed_digs *const     digs,
                              const struct dig_observation *const observation)
{
    struct dig_observation *const grown = realloc(digs->dig, (digs->digs + 1) * sizeof *digs->dig);
    if (grown == NULL) {
        return DIG_ENOMEM;
    }
    digs->dig               = grown;
    digs->dig[digs->digs++] = *observation;
    return DIG_OK;
}

// Drives the estimator through the recording and observes what it hands out.
static enum dig_status
drive(struct dig_estimator *const estimator, const struct dig_machine *const machine,
      const struct dig_friction stated[], const struct dig_curve_set *const set,
      const struct dig_estimator_settings *const settings,
      const struct dig_machine_recording *const recording, struct dig_observed_digs *const digs)
{
    struct dig_estimate    estimate = { .dig_count = 0 };
    struct dig_observation observation;
    enum dig_status        status = DIG_OK;
    const double           lambda = machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    for (size_t i = 0; i < recording->rows && status == DIG_OK; i++) {
        // A sample it cannot use is passed over, as in the daemon's tick.
        if (dig_estimator_step(estimator, &recording->row[i], &estimate) != DIG_OK) {
            continue;
        }
        struct dig_recorded_dig *const dug = dig_estimator_take_recording(estimator);
        if (dug != NULL) {
            dig_inertia_take_off(machine, stated, lambda, &dug->window);
            status = dig_recorded_dig_observe(set, settings, dug, &observation) == DIG_OK
                         ? append(digs, &observation)
                         : DIG_OK;
            dig_estimator_lend(estimator, dug);
        }
    }
    digs->seen = estimate.dig_count;
    return status;
}

// Tells the digs' depths; drops those off the table.
static enum dig_status tell_depths(const struct dig_curve_set *const set, const double limit_m,
                                   struct dig_observed_digs *const digs)
{
    const size_t              bytes                        = dig_depth_fit_size(set);
    void *const               memory                       = bytes > 0 ? malloc(bytes) : NULL;
    bool                      measured[DIG_TRAJECTORY_MAX] = { false };
    size_t                    kept                         = 0;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    if (bytes > 0 && memory == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < digs->digs; i++) {
        struct dig_observation *const dig = &digs->dig[i];
        const size_t                  t   = (size_t)dig->trajectory;
        if (!measured[t] && dig_approach_varies(set, t)) {
            dig_approach_error_measure(set, t, &error[t]);
            measured[t] = true;
        }
        if (dig_depth_fit(set, error, limit_m, memory, dig) == DIG_OK &&
            dig->last - dig->first >= DIG_OBSERVE_LEAST_PATH) {
            digs->dig[kept++] = *dig;
        }
    }
    digs->digs = kept;
    free(memory);
    return DIG_OK;
}

static enum dig_status observe(const struct dig_machine *const           machine,
                               const struct dig_corrected_machine *const corrected,
                               const struct dig_curve_set *const         set,
                               const struct dig_machine_recording *const recording,
                               struct dig_estimator *const               estimator,
                               struct dig_observed_digs *const digs, struct dig_error *const error)
{
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    enum dig_status status = dig_estimator_init(estimator, machine, set, &settings);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "machine %s: %s", machine->name,
                             dig_status_str(status));
    }
    status = dig_pressure_check(machine, recording, error);
    if (status != DIG_OK) {
        return status;
    }
    if (corrected != NULL) {
        dig_estimator_set_machine(estimator, corrected);
    }
    const bool corrects = corrected != NULL && corrected->corrects;
    status =
        drive(estimator, corrects ? &corrected->machine : machine,
              corrects ? corrected->correction.friction : NULL, set, &settings, recording, digs);
    if (status == DIG_OK) {
        status = tell_depths(set, settings.path_limit_m, digs);
    }
    if (status != DIG_OK) {
        return dig_error_set(error, status, "out of memory");
    }
    return digs->digs > 0
               ? DIG_OK
               : dig_error_set(error, DIG_ENOMATCH,
                               "digs in it: %zu, none of them along %.0f %% or more of a "
                               "trajectory of the table, as deep as that was dug, expected one or "
                               "more; where pressures are off in free air, no dig is seen to begin "
                               "or to end: check the machine (digloop check), or trace the digs",
                               digs->seen, 100.0 * DIG_OBSERVE_LEAST_PATH);
}

enum dig_status dig_observe_machine(const struct dig_machine *const           machine,
                                    const struct dig_corrected_machine *const corrected,
                                    const struct dig_curve_set *const         set,
                                    const struct dig_machine_recording *const recording,
                                    struct dig_observed_digs *const           digs,
                                    struct dig_error *const                   error)
{
    assert(machine != NULL && set != NULL && recording != NULL && digs != NULL);
    struct dig_estimator *const estimator = malloc(dig_estimator_size());
    if (estimator == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    struct dig_observed_digs found = { .digs = 0 };
    const enum dig_status    status =
        observe(machine, corrected, set, recording, estimator, &found, error);
    free(estimator);
    if (status != DIG_OK) {
        dig_observed_digs_finish(&found);
        return status;
    }
    *digs = found;
    return DIG_OK;
}

void dig_observed_digs_finish(struct dig_observed_digs *const digs)
{
    if (digs != NULL) {
        free(digs->dig);
        *digs = (struct dig_observed_digs){ .digs = 0 };
    }
}
