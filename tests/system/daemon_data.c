// What the daemon's system tests dig in: a table and two digs of a made-up soil whose curves are
// formulas, so that no DEM is needed and the truth is known.
//   daemon_data SCENE.yaml OUTDIR     writes OUTDIR/table.sqlite, simpleA.csv, actual.csv
//
// My(p) = rho/2500 (0.2 bump(p; .3) + 1.2 friction bump(p; .5) + 0.8 rolling bump(p; .7)) Nm with p
// the dig's progress in time and bump a raised cosine; Fx = -4 My / m, Fz = 2 My / m. Every packing
// scales it by one or two hundredths.

#include "core/units.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tables/store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEP_s 0.005

static const struct dig_gravel truth = { { 0.5, 0.4, 2200.0 } };

static double bump(const double p, const double middle)
{
    const double off = (p - middle) / 0.28;
    return fabs(off) < 1.0 ? 0.5 * (1.0 + cos(DIG_PI * off)) : 0.0;
}

static double moment_Nm(const struct dig_gravel *const gravel, const double p)
{
    return gravel->value[DIG_AXIS_DENSITY_kgpm3] / 2500.0 *
           (0.2 * bump(p, 0.3) + 1.2 * gravel->value[DIG_AXIS_FRICTION] * bump(p, 0.5) +
            0.8 * gravel->value[DIG_AXIS_ROLLING] * bump(p, 0.7));
}

static struct dig_recording dig(const struct dig_trajectory *const trajectory,
                                const struct dig_gravel *const gravel, const double scale)
{
    const double         duration_s = dig_trajectory_duration_s(trajectory);
    struct dig_recording recording  = { .rows = (size_t)(duration_s / STEP_s) };
    recording.row                   = calloc(recording.rows, sizeof recording.row[0]);
    for (size_t i = 0; recording.row != NULL && i < recording.rows; i++) {
        const double          t_s  = ((double)i + 0.5) * STEP_s;
        const struct dig_pose pose = dig_trajectory_pose(trajectory, t_s);
        const double          My   = scale * moment_Nm(gravel, t_s / duration_s);
        recording.row[i]           = (struct dig_force_row){
                      .t_s       = t_s,
                      .pin_x_m   = pose.x_m,
                      .pin_z_m   = pose.z_m,
                      .theta_deg = pose.theta_rad / DIG_RAD_PER_DEG,
                      .Fx_N      = -4.0 * My,
                      .Fz_N      = 2.0 * My,
                      .My_Nm     = My,
        };
    }
    return recording;
}

static enum dig_status put(struct dig_store *const            store,
                           const struct dig_trajectory *const trajectory, const size_t index,
                           const struct dig_gravel *const gravel, const size_t packing,
                           struct dig_error *const error)
{
    static const double   scale[] = { 0.98, 1.0, 1.02 };
    struct dig_run_origin origin  = {
         .gravel     = *gravel,
         .packing    = packing,
         .trajectory = index,
         .seed       = 1 + packing,
         .engine     = "formula",
         .version    = "test",
         .grains     = 1,
         .made_utc   = "2026-01-01T00:00:00Z",
    };
    struct dig_recording  recording = dig(trajectory, gravel, scale[packing]);
    const enum dig_status status    = dig_store_put(store, &origin, &recording, error);
    dig_recording_finish(&recording);
    return status;
}

static enum dig_status fill(struct dig_store *const store, const struct dig_scene *const scene,
                            struct dig_error *const error)
{
    static const double mu[] = { 0.3, 0.6, 0.9 }, rho[] = { 1500.0, 2500.0 };
    enum dig_status     status = DIG_OK;
    for (size_t i = 0; status == DIG_OK && i < 3 * 3 * 2 * 3 * scene->trajectories; i++) {
        const size_t            t      = i / 54;
        const struct dig_gravel gravel = { { mu[i % 3], mu[i / 3 % 3], rho[i / 9 % 2] } };
        status = put(store, &scene->trajectory[t], t, &gravel, i / 18 % 3, error);
    }
    return status;
}

static enum dig_status write_dig(const struct dig_scene *const scene, const char *const name,
                                 const char *const folder, struct dig_error *const error)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%.4000s/%s.csv", folder, name);
    struct dig_recording  recording = dig(dig_scene_find(scene, name), &truth, 1.0);
    const enum dig_status status    = dig_recording_write(path, &recording, error);
    dig_recording_finish(&recording);
    return status;
}

int main(const int argc, char *argv[])
{
    if (argc != 3) {
        (void)fprintf(stderr, "usage: daemon_data SCENE.yaml OUTDIR\n");
        return 2;
    }
    struct dig_error  error = { "" };
    struct dig_scene  scene;
    struct dig_store *store = NULL;
    char              path[4096];
    (void)snprintf(path, sizeof path, "%.4000s/table.sqlite", argv[2]);
    enum dig_status status = dig_scene_read(argv[1], &scene, &error);
    if (status == DIG_OK) {
        status = dig_store_create(path, &scene, &store, &error);
    }
    if (status == DIG_OK) {
        status = fill(store, &scene, &error);
    }
    dig_store_close(store);
    if (status == DIG_OK) {
        status = write_dig(&scene, "simpleA", argv[2], &error);
    }
    if (status == DIG_OK) {
        status = write_dig(&scene, "actual", argv[2], &error);
    }
    if (status != DIG_OK) {
        (void)fprintf(stderr, "daemon_data: %s\n", error.text);
        return 1;
    }
    (void)printf("friction %g rolling %g density %g\n", truth.value[0], truth.value[1],
                 truth.value[2]);
    return 0;
}
