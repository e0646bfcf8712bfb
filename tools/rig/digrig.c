// digrig: a machine to test against. See --help.

#include "core/recording.h"
#include "core/scene.h"
#include "core/streams.h"
#include "files/campaign_yaml.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tools/rig/buses.h"
#include "tools/rig/commands.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

// Bad input is the caller's to mend, the rest is the world's.
static int complain(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digrig: %s\n", error->text[0] ? error->text : dig_status_str(status));
    return status == DIG_EIO || status == DIG_ENOMEM ? EXIT_FAILED : EXIT_USAGE;
}

static enum dig_status read_tooth(const char *const scene_path, double *const tooth_m,
                                  struct dig_error *const error)
{
    struct dig_scene      scene;
    const enum dig_status status = dig_scene_read(scene_path, &scene, error);
    if (status == DIG_OK) {
        *tooth_m = dig_scene_tooth_m(&scene);
    }
    return status;
}

struct digs {
    size_t               recordings;
    struct dig_recording recording[DIG_CAMPAIGN_MAX];
};

static void digs_finish(struct digs *const digs)
{
    for (size_t i = 0; i < digs->recordings; i++) {
        dig_recording_finish(&digs->recording[i]);
    }
    free(digs);
}

// What is missing cannot be put on a machine.
static enum dig_status check_forces(const struct dig_recording *const recording,
                                    const char *const path, struct dig_error *const error)
{
    for (size_t i = 0; i < recording->rows; i++) {
        const struct dig_force_row *const row = &recording->row[i];
        if (!(isfinite(row->Fx_N) && isfinite(row->Fz_N) && isfinite(row->My_Nm))) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: Fx_N, Fz_N or My_Nm is missing at t_s %.6g, expected all "
                                 "three in every row",
                                 path, row->t_s);
        }
    }
    return DIG_OK;
}

static enum dig_status add_dig(struct digs *const digs, const char *const path,
                               struct dig_error *const error)
{
    if (digs->recordings == DIG_CAMPAIGN_MAX) {
        return dig_error_set(error, DIG_EINVAL, "%s: more than %d recordings", path,
                             DIG_CAMPAIGN_MAX);
    }
    struct dig_recording *const recording = &digs->recording[digs->recordings];
    const enum dig_status       status    = dig_recording_read(path, recording, error);
    digs->recordings += status == DIG_OK ? 1 : 0;
    return status == DIG_OK ? check_forces(recording, path, error) : status;
}

// All of a campaign, in its order; its scene counts unless another was given.
static enum dig_status add_campaign(struct digs *const digs, const char *const folder,
                                    const bool scene_given, double *const tooth_m,
                                    struct dig_error *const error)
{
    struct dig_campaign *const campaign = malloc(sizeof *campaign);
    if (campaign == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s", folder);
    }
    enum dig_status status = dig_campaign_read(folder, campaign, error);
    if (status == DIG_OK && !scene_given) {
        status = read_tooth(campaign->scene, tooth_m, error);
    }
    for (size_t i = 0; status == DIG_OK && i < campaign->recordings; i++) {
        status = add_dig(digs, campaign->recording[i].file, error);
    }
    free(campaign);
    return status;
}

static enum dig_status load(const struct dig_rig_options *const options,
                            struct dig_machine *const machine, double *const tooth_m,
                            struct digs *const digs, struct dig_error *const error)
{
    enum dig_status status = dig_machine_read(options->machine, machine, error);
    if (status == DIG_OK && options->scene != NULL) {
        status = read_tooth(options->scene, tooth_m, error);
    }
    for (size_t i = 0; i < options->inputs && status == DIG_OK; i++) {
        const char *const input = options->input[i];
        status                  = dig_campaign_is(input)
                                      ? add_campaign(digs, input, options->scene != NULL, tooth_m, error)
                                      : add_dig(digs, input, error);
    }
    // A file that cannot be opened is a bad argument here, not a failure of the work.
    return status == DIG_EIO ? DIG_EINVAL : status;
}

static void describe(const struct dig_machine *const machine, const double scene_tooth_m,
                     const bool tooth_known, const struct dig_rig_track *const track)
{
    char text[200];
    (void)fprintf(
        stderr,
        "digrig: %s, lambda %.2f, %.1f s; pin starts at X %.2f m, Z %.2f m; blended within "
        "%.1f mm, %.2f deg\n"
        "digrig: nearest limit, %.0f %% left: %s\n",
        machine->name, machine->link[DIG_JOINT_BUCKET].length_m / scene_tooth_m,
        (double)(track->rows - 1) * track->step_s, track->placement.X_m, track->placement.Z_m,
        1e3 * track->blend_off_m, 57.29578 * track->blend_off_rad, 100.0 * track->nearest.share,
        dig_rig_margin_text(&track->nearest, sizeof text, text));
    if (!tooth_known) {
        (void)fprintf(stderr,
                      "digrig: taken for digs of the rig's bucket, %.3f m from pin to tooth; "
                      "--scene says another\n",
                      scene_tooth_m);
    }
}

static void describe_air(const struct dig_machine *const   machine,
                         const struct dig_rig_track *const track)
{
    char text[200];
    (void)fprintf(stderr, "digrig: %s in free air, %.1f s; nearest limit, %.0f %% left: %s\n",
                  machine->name, (double)(track->rows - 1) * track->step_s,
                  100.0 * track->nearest.share,
                  dig_rig_margin_text(&track->nearest, sizeof text, text));
}

static int work(const struct dig_rig_options *const options)
{
    struct dig_error             error         = { "" };
    struct dig_machine           machine       = { .name = "" };
    struct dig_rig_track         track         = { .rows = 0 };
    struct dig_rig_track_options track_options = options->track;
    struct digs *const           digs          = calloc(1, sizeof *digs);
    if (digs == NULL) {
        return complain(DIG_ENOMEM, &error);
    }
    if (options->command == DIG_RIG_COMMAND_SERVE) {
        track_options.rate_Hz = DIG_RIG_TICK_Hz;
    }

    enum dig_status status = load(options, &machine, &track_options.scene_tooth_m, digs, &error);
    if (status == DIG_OK && machine.sensor.fitted && options->can != NULL) {
        status = dig_error_set(&error, DIG_EINVAL,
                               "%s: a force sensor has no layout on the CAN bus served here, "
                               "expected Modbus or record",
                               machine.name);
    }
    if (status == DIG_OK) {
        status = options->command == DIG_RIG_COMMAND_AIR
                     ? dig_rig_track_build_air(&machine, &track_options, &track, &error)
                     : dig_rig_track_build(&machine, &track_options, digs->recordings,
                                           digs->recording, &track, &error);
    }
    if (status == DIG_OK) {
        if (!options->quiet && options->command == DIG_RIG_COMMAND_AIR) {
            describe_air(&machine, &track);
        } else if (!options->quiet) {
            describe(&machine, track_options.scene_tooth_m,
                     options->scene != NULL || dig_campaign_is(options->input[0]), &track);
        }
        status = options->command == DIG_RIG_COMMAND_SERVE
                     ? dig_rig_serve(&machine, options, &track, &error)
                     : dig_rig_record(&machine, options, &track, &error);
    }
    dig_rig_track_finish(&track);
    digs_finish(digs);
    return status == DIG_OK ? EXIT_DONE : complain(status, &error);
}

int main(const int argc, char *argv[])
{
    struct dig_error       error = { "" };
    struct dig_rig_options options;
    dig_streams_begin();
    const enum dig_status status = dig_rig_options_parse(argc, argv, &options, &error);
    if (status != DIG_OK) {
        dig_rig_options_refuse(argv[1], &error);
        return EXIT_USAGE;
    }
    return dig_streams_end("digrig", work(&options));
}
