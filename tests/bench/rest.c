// How much a bed trembles that should lie still, by time step: pours a scene's bed at each step,
// watches it for 0.3 s without a tool, and prints of the last third the mean kinetic energy of a
// grain in m g r (rows: step, grains, energy), the pairs a grain that the contact list holds and
// those of them that touch.
//   rest SCENE.yaml FRICTION ROLLING DENSITY ASPECT STEP_us...
// ASPECT above 1: clumps of two spheres, as `digtable dig --effect grain_shape=ASPECT` makes them.

#include "files/scene_yaml.h"
#include "offline_dem/dig/dig.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/dig/variant.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define WATCH_s 0.3
#define EVERY   5 // odd: what flips from step to step is not always caught on one side

struct row {
    size_t grains, samples;
    double energy_mgr, picked, touching; // sums over samples, a grain
};

static size_t count_touching(const struct dig_world *const world, size_t *const picked)
{
    size_t touching = 0;
    *picked         = 0;
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        const struct dig_contacts *const list = &world->pair[l];
        for (size_t c = 0; c < list->n; c++) {
            const double *const a  = world->grains.motion[list->i[c]].x_m;
            const double *const b  = world->grains.motion[list->j[c]].x_m;
            double              d2 = 0.0;
            for (int k = 0; k < 3; k++) {
                d2 += (a[k] - b[k]) * (a[k] - b[k]);
            }
            touching += d2 < world->pair_law[l].reach_m * world->pair_law[l].reach_m;
        }
        *picked += list->n;
    }
    return touching;
}

static double unit_J(const struct dig_world *const world)
{
    double sum_J = 0.0;
    for (size_t i = 0; i < world->grains.n; i++) {
        const struct dig_grain_type *const type = &world->grains.type[world->grains.type_of[i]];
        sum_J += type->mass_kg * -world->gravity_mps2[2] * type->radius_m;
    }
    return sum_J;
}

static enum dig_status watch(struct dig_world *const world, struct row *const row)
{
    const size_t steps = (size_t)(WATCH_s / world->dt_s);
    row->grains        = world->grains.n;
    for (size_t s = 0; s < steps; s++) {
        const enum dig_status status = dig_world_step(world);
        if (status != DIG_OK) {
            return status;
        }
        if (s < steps - steps / 3 || s % EVERY != 0) {
            continue;
        }
        const enum dig_status synced = dig_world_sync_motion(world);
        if (synced != DIG_OK) {
            return synced;
        }
        size_t picked = 0;
        row->touching += (double)count_touching(world, &picked) / (double)row->grains;
        row->picked += (double)picked / (double)row->grains;
        row->energy_mgr += dig_grains_kinetic_J(&world->grains) / unit_J(world);
        row->samples++;
    }
    return DIG_OK;
}

static enum dig_status rest(const struct dig_scene *const scene, const struct dig_gravel *const g,
                            struct row *const row, struct dig_error *const error)
{
    struct dig_bed   bed    = { 0 };
    struct dig_world world  = { 0 };
    enum dig_status  status = dig_bed_pour(NULL, scene, g, 1, NULL, &bed, error);
    if (status == DIG_OK) {
        status = dig_setup_world(scene, g, &bed, 0.0, NULL, &world, error);
    }
    if (status == DIG_OK) {
        status = watch(&world, row);
        status = status == DIG_OK ? status : dig_setup_explain(status, error);
        dig_setup_finish(&world);
    }
    dig_bed_finish(&bed);
    return status;
}

int main(const int count, char **const word)
{
    if (count < 7) {
        (void)fprintf(stderr,
                      "usage: rest SCENE.yaml FRICTION ROLLING DENSITY ASPECT STEP_us...\n");
        return 2;
    }
    const struct dig_gravel gravel = { { strtod(word[2], NULL), strtod(word[3], NULL),
                                         strtod(word[4], NULL) } };
    const double            aspect = strtod(word[5], NULL);
    struct dig_scene        scene;
    struct dig_error        error = { "" };
    if (dig_scene_read(word[1], &scene, &error) != DIG_OK ||
        (aspect > 1.0 &&
         dig_variant_make(&scene, DIG_EFFECT_GRAIN_SHAPE, aspect, &scene, &error) != DIG_OK)) {
        (void)fprintf(stderr, "rest: %s\n", error.text);
        return 1;
    }
    scene.may_tremble = true;
    (void)printf("step_us grains energy_mgr picked touching\n");
    for (int k = 6; k < count; k++) {
        struct row row    = { 0 };
        scene.time_step_s = 1e-6 * strtod(word[k], NULL);
        if (rest(&scene, &gravel, &row, &error) != DIG_OK) {
            (void)printf("%s %s\n", word[k], error.text);
            continue;
        }
        const double n = fmax(1.0, (double)row.samples);
        (void)printf("%s %zu %.2g %.3f %.3f\n", word[k], row.grains, row.energy_mgr / n,
                     row.picked / n, row.touching / n);
        (void)fflush(stdout);
    }
    return 0;
}
