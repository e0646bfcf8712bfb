#include "offline_dem/dig.h"
#include "offline_dem/packing.h"
#include "offline_dem/setup.h"

#include <math.h>
#include <stdlib.h>

// Steps between two calls of the progress function.
#define TELL_STEPS 400

static enum dig_status go(struct dig_world *const world, const double duration_s,
                          const double done_s, const double total_s,
                          const struct dig_progress *const progress)
{
    const size_t steps = (size_t)llround(duration_s / world->dt_s);
    for (size_t s = 0; s < steps; s++) {
        const enum dig_status status = dig_world_step(world);
        if (status != DIG_OK) {
            return status;
        }
        if (progress != NULL && s % TELL_STEPS == 0 &&
            !progress->tell(progress->context, done_s + (double)s * world->dt_s, total_s)) {
            return DIG_ESTALE;
        }
    }
    return DIG_OK;
}

static enum dig_status level(struct dig_world *const world, const double z_max_m)
{
    unsigned char *const drop = calloc(world->grains.n + 1, 1);
    if (drop == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < world->grains.n; i++) {
        const double radius_m = world->grains.kind[world->grains.of[i]].radius_m;
        drop[i]               = world->grains.motion[i].x_m[2] > z_max_m - radius_m;
    }
    const enum dig_status status = dig_world_drop(world, drop);
    free(drop);
    return status;
}

static enum dig_status copy_bed(const struct dig_grains *const grains, struct dig_bed *const bed)
{
    const size_t   n    = grains->n;
    struct dig_bed made = {
        .grains   = n,
        .x_m      = malloc((n + 1) * sizeof(double)),
        .y_m      = malloc((n + 1) * sizeof(double)),
        .z_m      = malloc((n + 1) * sizeof(double)),
        .radius_m = malloc((n + 1) * sizeof(double)),
    };
    if (made.x_m == NULL || made.y_m == NULL || made.z_m == NULL || made.radius_m == NULL) {
        dig_bed_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        made.x_m[i]      = grains->motion[i].x_m[0];
        made.y_m[i]      = grains->motion[i].x_m[1];
        made.z_m[i]      = grains->motion[i].x_m[2];
        made.radius_m[i] = grains->kind[grains->of[i]].radius_m;
    }
    *bed = made;
    return DIG_OK;
}

static enum dig_status insert(const struct dig_scene *const scene, const double density_kgpm3,
                              const uint64_t seed, struct dig_grains *const grains)
{
    const size_t  n    = dig_packing_grains(scene);
    double *const work = malloc((4 * n + 1) * sizeof *work);
    if (work == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        work[3 * n + i] = 0.5 * scene->material.diameter_m;
    }
    enum dig_status status = dig_packing_insert(scene, seed, n, work, work + n, work + 2 * n);
    if (status == DIG_OK) {
        status =
            dig_grains_create(n, work, work + n, work + 2 * n, work + 3 * n, density_kgpm3, grains);
    }
    free(work);
    for (size_t i = 0; status == DIG_OK && i < n; i++) {
        grains->motion[i].v_mps[2] = -scene->packing.fall_mps;
    }
    return status;
}

enum dig_status dig_bed_pour(const struct dig_scene *const  scene,
                             const struct dig_gravel *const gravel, const uint64_t seed,
                             const struct dig_progress *const progress, struct dig_bed *const bed,
                             struct dig_error *const error)
{
    enum dig_status status = dig_setup_check(scene, gravel, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_grains grains;
    status = insert(scene, gravel->value[DIG_AXIS_DENSITY_kgpm3], seed, &grains);
    if (status != DIG_OK) {
        return dig_setup_explain(status, error);
    }
    struct dig_ode_scene *const ode = dig_ode_scene_create(scene);
    if (ode == NULL) {
        dig_grains_finish(&grains);
        return dig_setup_explain(DIG_ENOMEM, error);
    }
    struct dig_world world = dig_setup_world(scene, gravel, ode, &grains);
    dig_ode_scene_destroy(ode);
    const double total_s = scene->packing.settle_s + scene->packing.relax_s;
    status               = go(&world, scene->packing.settle_s, 0.0, total_s, progress);
    if (status == DIG_OK) {
        status = level(&world, scene->box.z_max_m);
    }
    if (status == DIG_OK) {
        status = go(&world, scene->packing.relax_s, scene->packing.settle_s, total_s, progress);
    }
    if (status == DIG_OK) {
        status = copy_bed(&world.grains, bed);
    }
    dig_world_finish(&world);
    return status == DIG_OK ? status : dig_setup_explain(status, error);
}

void dig_bed_finish(struct dig_bed *const bed)
{
    if (bed == NULL) {
        return;
    }
    free(bed->x_m);
    free(bed->y_m);
    free(bed->z_m);
    free(bed->radius_m);
    *bed = (struct dig_bed){ 0 };
}
