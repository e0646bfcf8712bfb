#include "tools/digloop/campaign.h"

#include "closed_loop/recordings/observe.h"
#include "core/name.h"
#include "core/regular.h"
#include "core/text.h"
#include "files/campaign_yaml.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/yaml/yaml.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"
#include "tools/digloop/scene.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *yaml_of(const struct digloop_job *const job, char path[const DIG_CAMPAIGN_PATH])
{
    (void)snprintf(path, DIG_CAMPAIGN_PATH, "%s/campaign.yaml", job->options->recording[0]);
    return path;
}

// A recording that cannot be read is told with the line that names it.
static enum dig_status tell_recording(const struct digloop_job *const job, const size_t i,
                                      const enum dig_status status, struct dig_error *const error)
{
    char yaml[DIG_CAMPAIGN_PATH];
    char key[40];
    (void)snprintf(key, sizeof key, "recordings[%zu].file", i);
    return dig_yaml_tell_namer(yaml_of(job, yaml), key, status, error);
}

static enum dig_status fill_heads(const struct digloop_job *const  job,
                                  const struct dig_campaign *const from,
                                  struct dig_measured measured[], struct dig_error *const error)
{
    const struct dig_curve_set *const set = job->set;
    for (size_t i = 0; i < from->recordings; i++) {
        const struct dig_campaign_recording *const r = &from->recording[i];
        (void)snprintf(measured[i].name, sizeof measured[i].name, "%.63s", dig_path_last(r->file));
        measured[i].order      = i;
        measured[i].trajectory = dig_curve_set_find(set, r->trajectory);
        measured[i].use        = (enum dig_use)r->role;
        measured[i].pass       = r->pass;
        if (measured[i].trajectory < 0) {
            char yaml[DIG_CAMPAIGN_PATH];
            char known[256] = "";
            for (size_t t = 0; t < set->trajectories; t++) {
                dig_text_list(sizeof known, known, set->trajectory[t].name);
            }
            return dig_yaml_refuse(yaml_of(job, yaml), error,
                                   "recordings[%zu].trajectory: \"%s\", expected one of the "
                                   "table's: %s",
                                   i, r->trajectory, known);
        }
    }
    return DIG_OK;
}

// A force recording as it would be of a dig in a scene lambda times smaller, by Froude similarity.
static void shrink(struct dig_recording *const recording, const double lambda)
{
    const double time   = sqrt(lambda);
    const double force  = lambda * lambda * lambda; // and masses
    const double moment = force * lambda;
    for (size_t i = 0; i < recording->rows; i++) {
        struct dig_force_row *const row = &recording->row[i];
        row->t_s /= time;
        row->pin_x_m /= lambda;
        row->pin_z_m /= lambda;
        row->Fx_N /= force;
        row->Fy_N /= force;
        row->Fz_N /= force;
        row->carried_kg /= force;
        row->Mx_Nm /= moment;
        row->My_Nm /= moment;
        row->Mz_Nm /= moment;
    }
}

// How deep the dig was, as the length of its first leg tells. It may as well have begun in the air.
static void tell_depth(const struct dig_curve_set *const set,
                       const struct dig_recording *const recording, struct dig_measured *const m)
{
    static const double same = 0.02; // of the depth
    struct dig_measured as_dug;
    if (dig_observe_as_dug(set, recording, &as_dug, NULL) == DIG_OK &&
        as_dug.trajectory == m->trajectory && fabs(as_dug.made.depth - 1.0) > same) {
        m->made.depth  = as_dug.made.depth;
        m->depth_share = 1.0;
    }
}

// The campaign's recording i.
static enum dig_status measure_force(const struct digloop_job *const            job,
                                     const struct dig_campaign_recording *const r, const size_t i,
                                     const double scale, struct dig_measured *const m,
                                     struct dig_error *const error)
{
    const struct dig_curve_set *const set       = job->set;
    struct dig_recording              recording = { 0 };
    const int                         asked     = m->trajectory;
    enum dig_status                   status =
        tell_recording(job, i, dig_recording_read(r->file, &recording, error), error);
    if (status == DIG_OK) {
        shrink(&recording, scale);
        status = dig_error_name(error, dig_observe_dig(set, &recording, m, error), "%s", r->file);
    }
    if (status == DIG_OK) {
        tell_depth(set, &recording, m);
    }
    dig_recording_finish(&recording);
    if (status == DIG_OK && m->trajectory != asked) {
        char yaml[DIG_CAMPAIGN_PATH];
        return dig_yaml_refuse(yaml_of(job, yaml), error,
                               "recordings[%zu].trajectory: \"%s\", expected %s, along which %s is "
                               "dug",
                               i, r->trajectory, set->trajectory[m->trajectory].name, r->file);
    }
    return status;
}

static enum dig_status load_machine(const struct digloop_job *const  job,
                                    const struct dig_campaign *const from,
                                    struct digloop_campaign *const   campaign,
                                    struct dig_error *const          error)
{
    if (from->machine[0] == '\0') {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: a machine recording, expected campaign.yaml to name a machine",
                             from->recording[0].file);
    }
    struct dig_machine                  machine;
    struct dig_machine_recording *const recording = calloc(from->recordings, sizeof *recording);
    if (recording == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    char            yaml[DIG_CAMPAIGN_PATH];
    enum dig_status status = dig_machine_read(from->machine, &machine, error);
    status                 = dig_yaml_tell_namer(yaml_of(job, yaml), "machine", status, error);
    if (status == DIG_OK && machine.sensor.fitted) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: a force sensor, expected a machine with cylinders or force "
                               "recordings: effects of cylinders are what is looked for in air",
                               from->machine);
    }
    if (status == DIG_OK) {
        status = digloop_check_bucket(job, from->machine, &machine, error);
    }
    campaign->lambda = machine.link[DIG_JOINT_BUCKET].length_m / job->set->tooth_m;
    for (size_t i = 0; i < from->recordings && status == DIG_OK; i++) {
        const char *const file = from->recording[i].file;
        status = tell_recording(job, i, digloop_read_machine(file, &machine, &recording[i], error),
                                error);
    }
    if (status == DIG_OK) {
        status = dig_machine_side_create(&machine, job->set, from->recordings, recording,
                                         campaign->measured, &campaign->machine, error);
    }
    for (size_t i = 0; i < from->recordings; i++) {
        dig_machine_recording_finish(&recording[i]);
    }
    free(recording);
    return status;
}

// A file that is not there is of no kind; reading it says so.
static enum dig_status check_kinds(const struct dig_campaign *const from,
                                   struct dig_error *const          error)
{
    static const char *const kind[] = { "a machine recording", "a force recording" };
    const char *const        first  = from->recording[0].file;
    const bool               force  = digloop_is_force_recording(first);
    for (size_t i = 1; i < from->recordings && access(first, F_OK) == 0; i++) {
        const char *const file = from->recording[i].file;
        if (access(file, F_OK) == 0 && digloop_is_force_recording(file) != force) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: %s, but %s is %s; expected one kind in a campaign: trace "
                                 "each in one of its own",
                                 file, kind[force ? 0 : 1], dig_path_last(first),
                                 kind[force ? 1 : 0]);
        }
    }
    return DIG_OK;
}

static enum dig_status load(const struct digloop_job *const  job,
                            const struct dig_campaign *const from,
                            struct digloop_campaign *const campaign, struct dig_error *const error)
{
    campaign->digs     = from->recordings;
    campaign->measured = calloc(from->recordings, sizeof *campaign->measured);
    if (campaign->measured == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    double          scale  = 1.0; // of force recordings; a machine knows its own
    enum dig_status status = digloop_check_scene(job, from->scene, &scale, error);
    if (status == DIG_OK) {
        status = fill_heads(job, from, campaign->measured, error);
    }
    if (status == DIG_OK) {
        status = check_kinds(from, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    if (!digloop_is_force_recording(from->recording[0].file)) {
        return load_machine(job, from, campaign, error);
    }
    campaign->lambda = scale;
    for (size_t i = 0; i < from->recordings && status == DIG_OK; i++) {
        status = measure_force(job, &from->recording[i], i, scale, &campaign->measured[i], error);
    }
    return status;
}

// A result may not take the place of what is read: the command's words alone were compared.
static enum dig_status check_results(const struct digloop_options *const options,
                                     const struct dig_campaign *const    from,
                                     struct dig_error *const             error)
{
    const char *const result[] = { options->json_out, options->html, options->add };
    for (size_t r = 0; r < sizeof result / sizeof result[0]; r++) {
        bool read = result[r] != NULL && (dig_regular_same(result[r], from->scene) ||
                                          dig_regular_same(result[r], from->machine));
        for (size_t i = 0; result[r] != NULL && i < from->recordings; i++) {
            read = read || dig_regular_same(result[r], from->recording[i].file);
        }
        if (read) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: to be written, and read by the campaign; expected another "
                                 "name",
                                 result[r]);
        }
    }
    return DIG_OK;
}

enum dig_status digloop_campaign_load(const struct digloop_job *const job,
                                      struct digloop_campaign *const  campaign,
                                      struct dig_error *const         error)
{
    assert(job != NULL && campaign != NULL);
    struct digloop_campaign    loaded = { .digs = 0 };
    struct dig_campaign *const from   = calloc(1, sizeof *from);
    if (from == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = dig_campaign_read(job->options->recording[0], from, error);
    if (status == DIG_OK) {
        status = check_results(job->options, from, error);
    }
    if (status == DIG_OK) {
        status = load(job, from, &loaded, error);
    }
    free(from);
    if (status != DIG_OK) {
        digloop_campaign_finish(&loaded);
        return dig_status_of_input(status);
    }
    *campaign = loaded;
    return DIG_OK;
}

void digloop_campaign_finish(struct digloop_campaign *const campaign)
{
    if (campaign != NULL) {
        dig_machine_side_destroy(campaign->machine);
        free(campaign->measured);
        memset(campaign, 0, sizeof *campaign);
    }
}
