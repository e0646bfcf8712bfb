// digrig: a machine to test against. See --help.

#include "core/recording.h"
#include "core/scene.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tools/rig/buses.h"
#include "tools/rig/options.h"
#include "tools/rig/record.h"
#include "tools/rig/serve.h"
#include "tools/rig/track.h"

#include <stdio.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

// Bad input is the caller's to mend, the rest is the world's.
static int complain(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digrig: %s\n", error->text[0] ? error->text : dig_status_str(status));
    return status == DIG_EIO || status == DIG_ENOMEM ? EXIT_FAILED : EXIT_USAGE;
}

static enum dig_status load(const struct dig_rig_options *const options,
                            struct dig_machine *const machine, double *const scene_tooth_m,
                            struct dig_recording recording[], struct dig_error *const error)
{
    enum dig_status status = dig_machine_read(options->machine, machine, error);
    if (status == DIG_OK && options->scene != NULL) {
        struct dig_scene scene;
        status = dig_scene_read(options->scene, &scene, error);
        if (status == DIG_OK) {
            *scene_tooth_m = dig_scene_tooth_m(&scene);
        }
    }
    for (size_t i = 0; i < options->inputs && status == DIG_OK; i++) {
        status = dig_recording_read(options->input[i], &recording[i], error);
    }
    // A file that cannot be opened is a bad argument here, not a failure of the work.
    return status == DIG_EIO ? DIG_EINVAL : status;
}

static void describe(const struct dig_machine *const machine, const double scene_tooth_m,
                     const struct dig_rig_track *const track)
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
}

static int work(const struct dig_rig_options *const options)
{
    struct dig_error             error                         = { "" };
    struct dig_machine           machine                       = { .name = "" };
    struct dig_recording         recording[DIG_RIG_INPUTS_MAX] = { { .rows = 0 } };
    struct dig_rig_track         track                         = { .rows = 0 };
    struct dig_rig_track_options track_options                 = options->track;
    if (options->command == DIG_RIG_COMMAND_SERVE) {
        track_options.rate_Hz = DIG_RIG_TICK_Hz;
    }

    enum dig_status status =
        load(options, &machine, &track_options.scene_tooth_m, recording, &error);
    if (status == DIG_OK) {
        status = dig_rig_track_build(&machine, &track_options, options->inputs, recording, &track,
                                     &error);
    }
    if (status == DIG_OK) {
        describe(&machine, track_options.scene_tooth_m, &track);
        status = options->command == DIG_RIG_COMMAND_RECORD
                     ? dig_rig_record(&machine, options, &track, &error)
                     : dig_rig_serve(&machine, options, &track, &error);
    }
    dig_rig_track_finish(&track);
    for (size_t i = 0; i < options->inputs; i++) {
        dig_recording_finish(&recording[i]);
    }
    return status == DIG_OK ? EXIT_DONE : complain(status, &error);
}

int main(const int argc, char *argv[])
{
    struct dig_error       error = { "" };
    struct dig_rig_options options;
    const enum dig_status  status = dig_rig_options_parse(argc, argv, &options, &error);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digrig: %s\nTry digrig --help.\n", error.text);
        return EXIT_USAGE;
    }
    if (options.command == DIG_RIG_COMMAND_HELP) {
        return fputs(dig_rig_options_help(), stdout) < 0 ? EXIT_FAILED : EXIT_DONE;
    }
    if (options.command == DIG_RIG_COMMAND_VERSION) {
        return printf("digrig %s\n", DIG_VERSION) < 0 ? EXIT_FAILED : EXIT_DONE;
    }
    return work(&options);
}
