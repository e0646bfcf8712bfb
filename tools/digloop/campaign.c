#include "tools/digloop/campaign.h"

#include "closed_loop/observe.h"
#include "files/campaign_yaml.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tools/digloop/recording.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// Shapes this much apart after scaling are two scenes.
static const double similar = 0.05;

static bool exists(const char *const path)
{
    struct stat found;
    return stat(path, &found) == 0;
}

static const char *last_part(const char *const path)
{
    const char *const slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static bool is_close(const double a, const double b, const double size)
{
    return fabs(a - b) <= similar * size;
}

// Durations scale as the root of the length; rates follow from poses.
static bool has_trajectory(const struct dig_curve_set *const  set,
                           const struct dig_trajectory *const t, const double scale)
{
    for (size_t i = 0; i < set->trajectories; i++) {
        const struct dig_trajectory *const own = &set->trajectory[i];
        if (strcmp(own->name, t->name) != 0) {
            continue;
        }
        const struct dig_pose a = dig_trajectory_pose(own, dig_trajectory_duration_s(own));
        const struct dig_pose b = dig_trajectory_pose(t, dig_trajectory_duration_s(t));
        return is_close(a.x_m - own->start_x_m, (b.x_m - t->start_x_m) / scale, set->tooth_m) &&
               is_close(a.z_m - own->start_z_m, (b.z_m - t->start_z_m) / scale, set->tooth_m) &&
               is_close(a.theta_rad, b.theta_rad, 1.0);
    }
    return true; // that the table lacks it matters when a dig follows it
}

static enum dig_status check_scene(const struct dig_campaign *const  from,
                                   const struct dig_curve_set *const set,
                                   struct dig_error *const           error)
{
    // A scene may be named instead of given: then by the name the table has.
    if (!exists(from->scene)) {
        return strcmp(last_part(from->scene), set->scene_name) == 0
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "%s: no such scene file, nor is it the table's scene \"%s\"",
                                   from->scene, set->scene_name);
    }
    struct dig_scene *const scene = calloc(1, sizeof *scene);
    if (scene == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = dig_scene_read(from->scene, scene, error);
    if (status == DIG_OK) {
        const double scale = dig_scene_tooth_m(scene) / set->tooth_m;
        bool         same =
            is_close(scene->bucket.width_m / scale, set->bucket_width_m, set->bucket_width_m);
        for (size_t i = 0; i < scene->trajectories; i++) {
            same = same && has_trajectory(set, &scene->trajectory[i], scale);
        }
        if (!same) {
            status = dig_error_set(error, DIG_EINVAL,
                                   "%s: scene \"%s\" is not similar to the table's \"%s\" (bucket "
                                   "and trajectories, within %.0f %% after scaling)",
                                   from->scene, scene->name, set->scene_name, 100.0 * similar);
        }
    }
    free(scene);
    return status;
}

static int find_trajectory(const struct dig_curve_set *const set, const char *const name)
{
    for (size_t t = 0; t < set->trajectories; t++) {
        if (strcmp(set->trajectory[t].name, name) == 0) {
            return (int)t;
        }
    }
    return -1;
}

static enum dig_status fill_heads(const struct dig_campaign *const  from,
                                  const struct dig_curve_set *const set,
                                  struct dig_measured measured[], struct dig_error *const error)
{
    for (size_t i = 0; i < from->recordings; i++) {
        const struct dig_campaign_recording *const r = &from->recording[i];
        (void)snprintf(measured[i].name, sizeof measured[i].name, "%.63s", last_part(r->file));
        measured[i].order      = i;
        measured[i].trajectory = find_trajectory(set, r->trajectory);
        measured[i].use        = (enum dig_use)r->role;
        measured[i].pass       = r->pass;
        if (measured[i].trajectory < 0) {
            return dig_error_set(error, DIG_EINVAL, "%s: the table has no trajectory \"%s\"",
                                 r->file, r->trajectory);
        }
    }
    return DIG_OK;
}

static enum dig_status measure_force(const struct dig_campaign_recording *const r,
                                     const struct dig_curve_set *const          set,
                                     struct dig_measured *const m, struct dig_error *const error)
{
    struct dig_recording recording = { 0 };
    struct dig_observed  o         = { .trajectory = 0 };
    struct dig_error     why       = { "" };
    enum dig_status      status    = dig_recording_read(r->file, &recording, error);
    if (status == DIG_OK) {
        status = dig_observe_dig(set, &recording, &o, &why);
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s: %s", r->file, why.text);
        }
    }
    dig_recording_finish(&recording);
    if (status != DIG_OK) {
        return status;
    }
    if (o.trajectory != m->trajectory) {
        return dig_error_set(error, DIG_EINVAL, "%s: a dig along %s, campaign.yaml says %s",
                             r->file, set->trajectory[o.trajectory].name, r->trajectory);
    }
    m->pace  = o.pace;
    m->first = 0.0;
    m->last  = 1.0;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        m->measured[c] = o.measured[c];
        memcpy(m->value[c], o.value[c], sizeof m->value[c]);
    }
    return DIG_OK;
}

static enum dig_status load_machine(const struct dig_campaign *const  from,
                                    const struct dig_curve_set *const set,
                                    struct digloop_campaign *const    campaign,
                                    struct dig_error *const           error)
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
    enum dig_status status = dig_machine_read(from->machine, &machine, error);
    if (status == DIG_OK && machine.sensor.fitted) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: a force sensor, expected a machine with cylinders or force "
                               "recordings: effects of cylinders are what is looked for in air",
                               from->machine);
    }
    for (size_t i = 0; i < from->recordings && status == DIG_OK; i++) {
        const char *const file = from->recording[i].file;
        status                 = digloop_read_machine(file, &machine, &recording[i], error);
    }
    if (status == DIG_OK) {
        status = dig_machine_side_create(&machine, set, from->recordings, recording,
                                         campaign->measured, &campaign->machine, error);
    }
    for (size_t i = 0; i < from->recordings; i++) {
        dig_machine_recording_finish(&recording[i]);
    }
    free(recording);
    return status;
}

static enum dig_status load(const struct dig_campaign *const  from,
                            const struct dig_curve_set *const set,
                            struct digloop_campaign *const campaign, struct dig_error *const error)
{
    campaign->digs     = from->recordings;
    campaign->measured = calloc(from->recordings, sizeof *campaign->measured);
    if (campaign->measured == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = check_scene(from, set, error);
    if (status == DIG_OK) {
        status = fill_heads(from, set, campaign->measured, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    if (!digloop_is_force_recording(from->recording[0].file)) {
        return load_machine(from, set, campaign, error);
    }
    for (size_t i = 0; i < from->recordings && status == DIG_OK; i++) {
        status = measure_force(&from->recording[i], set, &campaign->measured[i], error);
    }
    return status;
}

enum dig_status digloop_campaign_load(const char *const                 folder,
                                      const struct dig_curve_set *const set,
                                      struct digloop_campaign *const    campaign,
                                      struct dig_error *const           error)
{
    assert(folder != NULL && set != NULL && campaign != NULL);
    struct digloop_campaign    loaded = { .digs = 0 };
    struct dig_campaign *const from   = calloc(1, sizeof *from);
    if (from == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = dig_campaign_read(folder, from, error);
    if (status == DIG_OK) {
        status = load(from, set, &loaded, error);
    }
    free(from);
    if (status != DIG_OK) {
        digloop_campaign_finish(&loaded);
        return status;
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
