// digtable dig.

#include "offline_dem/dig/dig.h"
#include "core/text.h"
#include "files/bed_csv.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "offline_dem/dig/checked_pour.h"
#include "offline_dem/dig/input_checks.h"
#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/commands.h"
#include "tools/digtable/progress.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct dig_progress_report {
    struct dig_progress_line     line;
    double                       from_s;
    const char                  *what;
    const volatile sig_atomic_t *stop;
};

static int report_dig(void *const context, const double done_s, const double total_s)
{
    struct dig_progress_report *const w = context;
    if (dig_progress_is_due(&w->line)) {
        char         left[32];
        const double elapsed_s = dig_sweep_now_s() - w->from_s;
        const double left_s = done_s > 0.0 ? elapsed_s * (total_s - done_s) / done_s : (double)NAN;
        (void)fprintf(stderr, "%s%s: %.2f of %.2f s simulated, %s left",
                      dig_progress_start(&w->line), w->what, done_s, total_s,
                      dig_progress_span(left_s, sizeof left, left));
        dig_progress_end(&w->line, false);
    }
    return *w->stop == 0;
}

// Names the scene in what pouring or digging refused; a disk and a device name themselves.
static enum dig_status name_scene(const char *const path, const enum dig_status status,
                                  struct dig_error *const error)
{
    return status == DIG_EIO || status == DIG_ESTALE ? status
                                                     : dig_error_name(error, status, "%s", path);
}

// Refuses a scene whose beds a file cannot hold.
static enum dig_status check_bed_fits_file(const struct dig_scene *const scene,
                                           struct dig_error *const       error)
{
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        if (scene->bed.obstacle[i].movable) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu].movable: a bed file does not hold where a "
                                 "rock has come to lie, expected fixed rocks",
                                 i);
        }
    }
    return DIG_OK;
}

static enum dig_status get_bed(const struct dig_arguments *const a,
                               const struct dig_scene *const     scene,
                               const struct dig_gravel *const gravel, struct dig_bed *const bed,
                               struct dig_error *const error)
{
    if (a->bed != NULL) {
        struct dig_bed  read   = { 0 };
        enum dig_status status = dig_bed_read(a->bed, &read, error);
        if (status == DIG_OK && scene->bed.layers > 0 && read.material == NULL) {
            status = dig_error_set(
                error, DIG_EINVAL,
                "%s:1: column material: missing, expected one, as the scene has layers", a->bed);
        }
        status = status == DIG_OK ? dig_bed_check(scene, gravel, &read, error) : status;
        if (status != DIG_OK) {
            dig_bed_finish(&read);
            return status;
        }
        *bed = read;
        return DIG_OK;
    }
    struct dig_progress_report watch    = { dig_progress_line(a->quiet), dig_sweep_now_s(), "bed",
                                            a->stop };
    const struct dig_progress  progress = { report_dig, &watch };
    const struct dig_engine    engine   = dig_cli_engine(a);
    const enum dig_status      status   = name_scene(
               a->positional[0],
               engine.pour(&engine.stepper, scene, gravel, a->seed, &progress, bed, error), error);
    if (status == DIG_OK && watch.line.tty) {
        dig_progress_end(&watch.line, true);
    }
    return status;
}

static enum dig_status
dig_and_write(const struct dig_arguments *const a, const struct dig_scene *const scene,
              const struct dig_gravel *const gravel, const struct dig_bed *const bed,
              const struct dig_trajectory *const trajectory, struct dig_error *const error)
{
    struct dig_progress_report watch     = { dig_progress_line(a->quiet), dig_sweep_now_s(), "dig",
                                             a->stop };
    const struct dig_progress  progress  = { report_dig, &watch };
    const struct dig_engine    engine    = dig_cli_engine(a);
    struct dig_recording       recording = { 0 };
    enum dig_status            status    = DIG_OK;
    if (a->save_bed != NULL) {
        status = dig_bed_write(a->save_bed, bed, error);
    }
    if (status == DIG_OK) {
        status = engine.dig(&engine.stepper, scene, gravel, bed, trajectory, a->vtk, &progress,
                            &recording, error);
        // As few as a table refuses.
        if (status == DIG_OK && recording.rows < 2) {
            status =
                dig_error_set(error, DIG_EINVAL,
                              "trajectories: %s gives %zu rows of output_s, expected 2 or more",
                              trajectory->name, recording.rows);
        }
        status = name_scene(a->positional[0], status, error);
    }
    if (status == DIG_OK) {
        status = dig_recording_write(a->output, &recording, error);
    }
    if (status == DIG_OK && !a->quiet) {
        (void)fputs(dig_progress_start(&watch.line), stderr);
        dig_text_print(stderr, "%zu grains, %zu samples, %.1f s -> %s", bed->grains, recording.rows,
                       dig_sweep_now_s() - watch.from_s, a->output);
        dig_progress_end(&watch.line, true);
    }
    dig_recording_finish(&recording);
    return status;
}

// The trajectory at the approach asked for, checked before the minutes of pouring.
static enum dig_status approach(const struct dig_scene *const     scene,
                                const struct dig_arguments *const a,
                                struct dig_trajectory *const made, struct dig_error *const error)
{
    struct dig_trajectory dug;
    enum dig_status       status =
        dig_approach_make(scene, dig_scene_find(scene, a->trajectory), &a->approach, &dug, error);
    if (status == DIG_OK) {
        status = dig_input_checks_path(scene, &dug, error);
    }
    status = name_scene(a->positional[0], status, error);
    if (status == DIG_OK) {
        *made = dug;
    }
    return status;
}

int dig_cli_dig(const struct dig_arguments *const a)
{
    if (a->trajectory == NULL || a->output == NULL) {
        return dig_cli_bad_usage(a, "dig: %s missing",
                                 a->output == NULL ? "-o CURVE.csv" : "--trajectory NAME");
    }
    struct dig_gravel gravel;
    for (int i = 0; i < DIG_AXES; i++) {
        gravel.value[i] = a->gravel[i];
        if (isnan(a->gravel[i])) {
            static const char *const option[DIG_AXES] = { "--friction", "--rolling", "--density" };
            return dig_cli_bad_usage(a, "dig: %s missing", option[i]);
        }
    }
    struct dig_error error = { "" };
    struct dig_scene scene;
    enum dig_status  status = dig_scene_read(a->positional[0], &scene, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    if (dig_scene_find(&scene, a->trajectory) == NULL) {
        dig_text_print(stderr,
                       "digtable: %s: trajectories: no \"%s\", expected one of:", a->positional[0],
                       a->trajectory);
        for (size_t i = 0; i < scene.trajectories; i++) {
            (void)fprintf(stderr, " %s", scene.trajectory[i].name);
        }
        (void)fputc('\n', stderr);
        return EXIT_BAD_INPUT;
    }
    if (!isnan(a->young_Pa)) {
        scene.material.young_Pa = a->young_Pa;
    }
    struct dig_trajectory trajectory;
    status = approach(&scene, a, &trajectory, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }

    if ((a->save_bed != NULL || a->bed != NULL) && check_bed_fits_file(&scene, &error) != DIG_OK) {
        return dig_cli_bad_input(DIG_EINVAL, &error);
    }

    // Before the minutes of pouring: an impossible folder must not cost them.
    if (a->vtk != NULL && mkdir(a->vtk, 0777) != 0 && errno != EEXIST) {
        dig_text_print(stderr, "digtable: --vtk %s: %s\n", a->vtk, strerror(errno));
        return EXIT_WORK_FAILED;
    }

    struct dig_bed bed = { 0 };
    status             = get_bed(a, &scene, &gravel, &bed, &error);
    if (status != DIG_OK) {
        return a->bed != NULL ? dig_cli_bad_input(status, &error)
                              : dig_cli_work_failed(status, &error);
    }
    status = dig_and_write(a, &scene, &gravel, &bed, &trajectory, &error);
    dig_bed_finish(&bed);
    return status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
}
