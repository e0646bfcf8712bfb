#include "tools/digloop/recording.h"

#include "closed_loop/machine_digs/recording_faults.h"
#include "closed_loop/recordings/observe.h"
#include "core/sample.h"
#include "core/text.h"
#include "estimator/approach/approach_slots.h"
#include "files/lcm/lcm_log.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "firmware_host/config/load_model.h"
#include "tools/digloop/scene.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The first line of a recording that is not a comment names its columns; an LCM log has none.
bool digloop_is_force_recording(const char *const path)
{
    assert(path != NULL);
    return !dig_lcm_log_is(path) && !dig_machine_recording_is(path);
}

// The signals must be those the machine has: else not one sample could be used.
static enum dig_status check_kind(const struct dig_machine *const           machine,
                                  const struct dig_machine_recording *const recording,
                                  const char *const file, struct dig_error *const error)
{
    bool senses = false;
    for (size_t i = 0; i < recording->rows; i++) {
        senses = senses || recording->row[i].valid[DIG_SIGNAL_SENSOR_MY_Nm];
    }
    return senses == machine->sensor.fitted
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL, "%s: %s, expected what machine %s has", file,
                               senses ? "readings of a force sensor" : "none of a force sensor",
                               machine->name);
}

// What a sensor cut off would be taken for the soil's, or for an effect.
static enum dig_status check_range(const struct dig_machine *const           machine,
                                   const struct dig_machine_recording *const recording,
                                   const char *const file, struct dig_error *const error)
{
    struct dig_clip clip;
    return dig_saturation_find(machine, recording, &clip)
               ? dig_error_set(error, DIG_EINVAL,
                               "%s: %s stays at its highest value, %.4g Pa, for %.1f s: clipped, "
                               "expected a pressure within the sensor's range",
                               file, dig_signal_name(clip.signal), clip.limit_Pa, clip.time_s)
               : DIG_OK;
}

enum dig_status digloop_read_machine(const char *const                   path,
                                     const struct dig_machine *const     machine,
                                     struct dig_machine_recording *const recording,
                                     struct dig_error *const             error)
{
    assert(path != NULL && machine != NULL && recording != NULL);
    struct dig_machine_recording read   = { .rows = 0 };
    enum dig_status              status = dig_machine_recording_read(path, &read, error);
    if (status == DIG_OK) {
        status = check_kind(machine, &read, path, error);
    }
    if (status == DIG_OK) {
        status = check_range(machine, &read, path, error);
    }
    if (status != DIG_OK) {
        dig_machine_recording_finish(&read);
        return status;
    }
    *recording = read;
    return DIG_OK;
}

enum dig_status digloop_load_machine(const struct digloop_job *const job,
                                     struct digloop_machine *const   machine,
                                     struct dig_error *const         error)
{
    assert(job != NULL && machine != NULL);
    const struct digloop_options *const options = job->options;
    struct digloop_machine              loaded  = { .lambda = 0.0 };
    const bool                          any     = options->machine != NULL;
    enum dig_status                     status  = DIG_OK;
    if (any) {
        status = dig_machine_read(options->machine, &loaded.machine, error);
    }
    if (status == DIG_OK && any) {
        loaded.lambda = loaded.machine.link[DIG_JOINT_BUCKET].length_m / job->set->tooth_m;
        status        = digloop_check_bucket(job, options->machine, &loaded.machine, error);
    }
    if (status == DIG_OK && options->model != NULL) {
        status = dig_load_model(options->model, options->table, any ? &loaded.machine : NULL,
                                job->set, &loaded.corrected, error);
    }
    if (status == DIG_OK) {
        *machine = loaded;
    }
    return dig_status_of_input(status);
}

// Moment and forces, as a sensor of all three gives them: without a sigma of its own.
static enum dig_status observe_force(const struct dig_curve_set *const set,
                                     const struct dig_recording *const recording,
                                     struct dig_observation *const     dig,
                                     struct dig_error *const           error)
{
    const struct dig_approach none = { .depth = 0.0 };
    struct dig_measured       seen;
    const enum dig_status     status = dig_observe_as_dug(set, recording, &seen, error);
    if (status != DIG_OK) {
        return status;
    }
    *dig = (struct dig_observation){
        .dig_count  = 1,
        .trajectory = seen.trajectory,
        .off_path_m = seen.off_path_m,
        .approach   = seen.approach,
        .made       = dig_approach_varies(set, (size_t)seen.trajectory) ? seen.made : none,
        .first      = seen.first,
        .last       = seen.last,
        .forces     = seen.measured[DIG_CHANNEL_FX_N] && seen.measured[DIG_CHANNEL_FZ_N],
    };
    memcpy(dig->moment_Nm, seen.value[DIG_CHANNEL_MY_Nm], sizeof dig->moment_Nm);
    memcpy(dig->force_N[0], seen.value[DIG_CHANNEL_FX_N], sizeof dig->force_N[0]);
    memcpy(dig->force_N[1], seen.value[DIG_CHANNEL_FZ_N], sizeof dig->force_N[1]);
    return DIG_OK;
}

// The one dig of a force recording.
static enum dig_status read_force(const char *const path, const struct dig_curve_set *const set,
                                  struct dig_observed_digs *const digs,
                                  struct dig_error *const         error)
{
    struct dig_recording recording = { 0 };
    enum dig_status      status    = dig_recording_read(path, &recording, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_observation *const dig = calloc(1, sizeof *dig);
    status                            = dig != NULL ? observe_force(set, &recording, dig, error)
                                                    : dig_error_set(error, DIG_ENOMEM, "out of memory");
    dig_recording_finish(&recording);
    if (status != DIG_OK) {
        free(dig);
        return dig_error_name(error, status, "%s", path);
    }
    *digs = (struct dig_observed_digs){ .digs = 1, .dig = dig, .seen = 1 };
    return DIG_OK;
}

static enum dig_status read_samples(const struct digloop_job *const job, const char *const path,
                                    struct dig_observed_digs *const digs,
                                    struct dig_error *const         error)
{
    const struct digloop_machine *const machine = job->machine;
    if (machine == NULL) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: no force recording, expected --machine MACHINE.yaml for a "
                             "machine recording or an LCM log",
                             path);
    }
    struct dig_machine_recording recording = { .rows = 0 };
    enum dig_status status = digloop_read_machine(path, &machine->machine, &recording, error);
    if (status == DIG_OK) {
        status = dig_error_name(error,
                                dig_observe_machine(&machine->machine, &machine->corrected,
                                                    job->set, &recording, digs, error),
                                "%s", path);
    }
    dig_machine_recording_finish(&recording);
    return status;
}

enum dig_status digloop_read_digs(const struct digloop_job *const job, const char *const path,
                                  const int trajectory, struct dig_observed_digs *const digs,
                                  struct dig_error *const error)
{
    assert(job != NULL && path != NULL && digs != NULL);
    assert(trajectory < (int)job->set->trajectories);
    struct dig_observed_digs read   = { .digs = 0 };
    enum dig_status          status = digloop_is_force_recording(path)
                                          ? read_force(path, job->set, &read, error)
                                          : read_samples(job, path, &read, error);
    if (status != DIG_OK || read.dig == NULL) {
        return dig_status_of_input(status);
    }
    size_t kept = 0;
    for (size_t i = 0; i < read.digs; i++) {
        if (trajectory < 0 || read.dig[i].trajectory == trajectory) {
            read.dig[kept++] = read.dig[i];
        }
    }
    if (kept == 0) {
        status = dig_error_set(error, DIG_ENOMATCH, "%s: a dig along %s, expected one along %s",
                               path, job->set->trajectory[read.dig[0].trajectory].name,
                               job->set->trajectory[trajectory].name);
        dig_observed_digs_finish(&read);
        return status;
    }
    read.digs = kept;
    *digs     = read;
    return DIG_OK;
}

enum dig_status digloop_find_trajectory(const struct digloop_job *const job, int *const trajectory,
                                        struct dig_error *const error)
{
    const int found = dig_curve_set_find(job->set, job->options->trajectory);
    if (found < 0) {
        char names[256] = "";
        for (size_t t = 0; t < job->set->trajectories; t++) {
            dig_text_list(sizeof names, names, job->set->trajectory[t].name);
        }
        return dig_error_set(error, DIG_EINVAL,
                             "--trajectory %s: no such trajectory, expected one of %s: %s",
                             job->options->trajectory, job->options->table, names);
    }
    *trajectory = found;
    return DIG_OK;
}
