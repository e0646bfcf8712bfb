// What the daemon's system tests dig in: a table and two digs of a made-up soil whose curves are
// formulas, so that no DEM is needed and the truth is known.
//   daemon_data SCENE.yaml OUTDIR     writes OUTDIR/table.sqlite, simpleA.csv, simpleB.csv,
//   actual.csv daemon_data SCENE.yaml OUTDIR other
//       writes OUTDIR/other.sqlite alone: the same soil, in 27 other gravels
//   daemon_data SCENE.yaml OUTDIR ways
//       writes OUTDIR/ways.sqlite, of simpleA dug at several depths and attacks, and deep.csv and
//       far.csv, in the table's depths and beyond
//
// My(p) = rho/2500 (0.2 bump(p; .3) + 1.2 friction bump(p; .5) + 0.8 rolling bump(p; .7)) Nm with p
// the dig's progress in time and bump a raised cosine; Fx = -4 My / m, Fz = 2 My / m. Every packing
// scales it by one or two hundredths. Where depths differ the soil begins to resist at once,
// 0.6 friction times the share of the first phase that is done, less as the dig goes on, and all
// grows with the square of the depth and with 1 - 1.5 attack.

#include "core/units.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "tables/store.h"

#include <math.h>
#include <stdbool.h>
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

// What a dig made so resists with more than the plain one of the first table.
static double deep_Nm(const struct dig_trajectory *const trajectory,
                      const struct dig_approach *const   approach,
                      const struct dig_gravel *const gravel, const double t_s)
{
    const double p     = t_s / dig_trajectory_duration_s(trajectory);
    const double begun = fmin(t_s / trajectory->phase[0].duration_s, 1.0);
    const double more  = gravel->value[DIG_AXIS_DENSITY_kgpm3] / 2500.0 * 0.6 *
                        gravel->value[DIG_AXIS_FRICTION] * begun * (1.0 - p);
    return (approach->depth * approach->depth - 1.5 * approach->attack_rad) *
           (more + moment_Nm(gravel, p));
}

// approach: of that trajectory, whose soil resists from the start; NULL: as it stands.
static struct dig_recording dig(const struct dig_trajectory *const trajectory,
                                const struct dig_approach *const   approach,
                                const struct dig_gravel *const gravel, const double scale)
{
    const double         duration_s = dig_trajectory_duration_s(trajectory);
    struct dig_recording recording  = { .rows = (size_t)(duration_s / STEP_s) };
    recording.row                   = calloc(recording.rows, sizeof recording.row[0]);
    for (size_t i = 0; recording.row != NULL && i < recording.rows; i++) {
        const double          t_s  = ((double)i + 0.5) * STEP_s;
        const struct dig_pose pose = dig_trajectory_pose(trajectory, t_s);
        const double My  = scale * (approach != NULL ? deep_Nm(trajectory, approach, gravel, t_s)
                                                     : moment_Nm(gravel, t_s / duration_s));
        recording.row[i] = (struct dig_force_row){
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

static enum dig_status put(struct dig_store *const store, const struct dig_trajectory *const dug,
                           const struct dig_run_origin *const key, const bool varies,
                           struct dig_error *const error)
{
    static const double   scale[] = { 0.98, 1.0, 1.02 };
    struct dig_run_origin origin  = *key;
    origin.seed                   = 1 + key->packing;
    origin.grains                 = 1;
    (void)snprintf(origin.engine, sizeof origin.engine, "formula");
    (void)snprintf(origin.version, sizeof origin.version, "test");
    (void)snprintf(origin.made_utc, sizeof origin.made_utc, "2026-01-01T00:00:00Z");
    struct dig_recording recording =
        dig(dug, varies ? &key->approach : NULL, &key->gravel, scale[key->packing]);
    const enum dig_status status = dig_store_put(store, &origin, &recording, error);
    dig_recording_finish(&recording);
    return status;
}

// The gravels of a table: three frictions, as many of rolling, and densities; three packings each.
struct gravels {
    double mu[3];
    size_t densities;
    double rho[3];
};
static const struct gravels gravels_of_table = { { 0.3, 0.6, 0.9 }, 2, { 1500.0, 2500.0 } };
static const struct gravels gravels_of_other = { { 0.25, 0.55, 0.85 },
                                                 3,
                                                 { 1400.0, 2000.0, 2600.0 } };

static enum dig_status fill(struct dig_store *const store, const struct dig_scene *const scene,
                            const struct gravels *const g, struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    const size_t    all    = 3 * 3 * g->densities;
    for (size_t i = 0; status == DIG_OK && i < all * 3 * scene->trajectories; i++) {
        const struct dig_run_origin key = {
            .gravel     = { { g->mu[i % 3], g->mu[i / 3 % 3], g->rho[i / 9 % g->densities] } },
            .packing    = i / all % 3,
            .trajectory = i / all / 3,
        };
        status = put(store, &scene->trajectory[key.trajectory], &key, false, error);
    }
    return status;
}

// simpleA at a cross of depths and attacks, in four gravels, two packings where it is plain, 2 % to
// either side.
static enum dig_status fill_ways(struct dig_store *const store, const struct dig_scene *const scene,
                                 struct dig_error *const error)
{
    static const double mu[] = { 0.3, 0.7 };
    static const struct {
        struct dig_approach approach;
        size_t              packing;
    } way[] = { { { 1.0, 0.0 }, 0 }, { { 1.0, 0.0 }, 2 },  { { 0.8, 0.0 }, 1 },
                { { 1.2, 0.0 }, 1 }, { { 1.0, -0.1 }, 1 }, { { 1.0, 0.1 }, 1 } };
    const struct dig_trajectory *const simple = dig_scene_find(scene, "simpleA");
    enum dig_status                    status = DIG_OK;
    for (size_t i = 0; status == DIG_OK && i < 4 * sizeof way / sizeof way[0]; i++) {
        struct dig_trajectory       dug;
        const size_t                w   = i / 4;
        const struct dig_run_origin key = {
            .gravel     = { { mu[i % 2], mu[i / 2 % 2], 2200.0 } },
            .approach   = way[w].approach,
            .packing    = way[w].packing,
            .trajectory = (size_t)(simple - scene->trajectory),
        };
        status = dig_approach_make(scene, simple, &way[w].approach, &dug, error);
        if (status == DIG_OK) {
            status = put(store, &dug, &key, true, error);
        }
    }
    return status;
}

// Of the true gravel.
static enum dig_status write_dig(const struct dig_trajectory *const trajectory,
                                 const struct dig_approach *const   approach,
                                 const char *const folder, const char *const name,
                                 struct dig_error *const error)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%.4000s/%s.csv", folder, name);
    struct dig_recording  recording = dig(trajectory, approach, &truth, 1.0);
    const enum dig_status status    = dig_recording_write(path, &recording, error);
    dig_recording_finish(&recording);
    return status;
}

static enum dig_status write_simple_at(const struct dig_scene *const scene, const double depth,
                                       const char *const folder, const char *const name,
                                       struct dig_error *const error)
{
    const struct dig_approach          approach = { .depth = depth };
    const struct dig_trajectory *const simple   = dig_scene_find(scene, "simpleA");
    struct dig_trajectory              dug;
    const enum dig_status status = dig_approach_make(scene, simple, &approach, &dug, error);
    return status == DIG_OK ? write_dig(&dug, &approach, folder, name, error) : status;
}

static enum dig_status write_digs(const struct dig_scene *const scene, const char *const folder,
                                  const bool ways, struct dig_error *const error)
{
    if (ways) {
        const enum dig_status status = write_simple_at(scene, 1.12, folder, "deep", error);
        return status == DIG_OK ? write_simple_at(scene, 1.7, folder, "far", error) : status;
    }
    static const char *const name[] = { "simpleA", "simpleB", "actual" };
    enum dig_status          status = DIG_OK;
    for (size_t i = 0; i < sizeof name / sizeof name[0] && status == DIG_OK; i++) {
        status = write_dig(dig_scene_find(scene, name[i]), NULL, folder, name[i], error);
    }
    return status;
}

int main(const int argc, char *argv[])
{
    const char *const which = argc == 4 ? argv[3] : "table";
    const bool        ways  = strcmp(which, "ways") == 0;
    const bool        other = strcmp(which, "other") == 0;
    if (argc != 3 && !(argc == 4 && (ways || other))) {
        (void)fprintf(stderr, "usage: daemon_data SCENE.yaml OUTDIR [ways|other]\n");
        return 2;
    }
    struct dig_error  error = { "" };
    struct dig_scene  scene;
    struct dig_store *store = NULL;
    char              path[4096];
    (void)snprintf(path, sizeof path, "%.4000s/%s.sqlite", argv[2], which);
    enum dig_status status = dig_scene_read(argv[1], &scene, &error);
    if (status == DIG_OK) {
        status = dig_store_create(path, &scene, &store, &error);
    }
    status = status == DIG_OK ? dig_store_begin(store, &error) : status;
    if (status == DIG_OK) {
        status = ways ? fill_ways(store, &scene, &error)
                      : fill(store, &scene, other ? &gravels_of_other : &gravels_of_table, &error);
    }
    status = status == DIG_OK ? dig_store_commit(store, &error) : status;
    dig_store_close(store);
    if (status == DIG_OK && !other) {
        status = write_digs(&scene, argv[2], ways, &error);
    }
    if (status != DIG_OK) {
        (void)fprintf(stderr, "daemon_data: %s\n", error.text);
        return 1;
    }
    (void)printf("friction %g rolling %g density %g\n", truth.value[0], truth.value[1],
                 truth.value[2]);
    return 0;
}
