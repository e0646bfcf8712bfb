#include "offline_dem/dig/dig.h"
#include "offline_dem/dig/level.h"
#include "offline_dem/dig/packing.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <stdlib.h>

// Steps between two progress reports.
#define PROGRESS_STEPS 400

static enum dig_status step_for(struct dig_world *const world, const double duration_s,
                                const double done_s, const double total_s,
                                const struct dig_progress *const progress)
{
    const size_t steps = (size_t)llround(duration_s / world->dt_s);
    for (size_t s = 0; s < steps; s++) {
        const enum dig_status status = dig_world_step(world);
        if (status != DIG_OK) {
            return status;
        }
        if (progress != NULL && s % PROGRESS_STEPS == 0 &&
            !progress->report(progress->context, done_s + (double)s * world->dt_s, total_s)) {
            return DIG_ESTALE;
        }
    }
    return DIG_OK;
}

// Assigns materials by the height of the grains, or of the middles of their clumps.
static void assign_layers(const struct dig_scene *const scene, struct dig_bed *const bed)
{
    const size_t spheres = scene->bed.clump.spheres > 0 ? scene->bed.clump.spheres : 1;
    for (size_t first = 0; first < bed->grains; first += spheres) {
        double z_m = 0.0;
        for (size_t k = 0; k < spheres; k++) {
            z_m += bed->z_m[first + k] / (double)spheres;
        }
        size_t material = 0;
        for (size_t l = 0; l < scene->bed.layers; l++) {
            const struct dig_layer *const layer = &scene->bed.layer[l];
            if (z_m >= layer->from_m && z_m < layer->to_m) {
                material = layer->material;
            }
        }
        for (size_t k = 0; k < spheres; k++) {
            bed->material[first + k] = (uint8_t)material;
        }
    }
}

// One pouring under way.
struct pour {
    const struct dig_scene  *scene;
    const struct dig_gravel *gravel;
    struct dig_stepper       stepper;
    struct dig_grain_types   types;
    struct dig_world         world;
};

// The world of a bed.
static enum dig_status make_world(struct pour *const p, const struct dig_bed *const bed,
                                  const double fall_mps, struct dig_error *const error)
{
    enum dig_status status =
        dig_setup_world(p->scene, p->gravel, bed, fall_mps, &p->types, &p->world, error);
    return status == DIG_OK ? dig_setup_stepper(&p->stepper, &p->world, error) : status;
}

struct numbered {
    uint32_t id, place;
};

static int by_id(const void *const a, const void *const b)
{
    const uint32_t x = ((const struct numbered *)a)->id;
    const uint32_t y = ((const struct numbered *)b)->id;
    return (x > y) - (x < y);
}

// Copies the grains' positions; material[type] is the material of each type, NULL: all gravel.
// Spheres of a clump keep their order.
static enum dig_status copy_grains(const struct dig_grains *const grains, const size_t material[],
                                   struct dig_bed *const bed)
{
    const size_t           n     = grains->n;
    struct numbered *const order = malloc((n + 1) * sizeof *order);
    struct dig_bed         made  = { 0 };
    if (order == NULL ||
        dig_bed_create(n, material != NULL, grains->clump != NULL, &made) != DIG_OK) {
        free(order);
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        order[i] = (struct numbered){ grains->id[i], (uint32_t)i };
    }
    if (grains->clump != NULL) {
        qsort(order, n, sizeof *order, by_id);
    }
    for (size_t k = 0; k < n; k++) {
        const size_t i   = order[k].place;
        made.x_m[k]      = grains->motion[i].x_m[0];
        made.y_m[k]      = grains->motion[i].x_m[1];
        made.z_m[k]      = grains->motion[i].x_m[2];
        made.radius_m[k] = grains->type[grains->type_of[i]].radius_m;
        if (material != NULL) {
            made.material[k] = (uint8_t)material[grains->type_of[i]];
        }
        if (grains->clump != NULL) {
            made.clump[k] = grains->clump[i];
        }
    }
    free(order);
    *bed = made;
    return DIG_OK;
}

static enum dig_status copy_bed(struct pour *const p, const size_t material[],
                                struct dig_bed *const bed)
{
    enum dig_status status = dig_world_sync_motion(&p->world);
    status = status == DIG_OK ? copy_grains(&p->world.grains, material, bed) : status;
    if (status == DIG_OK && p->world.bodies != NULL) {
        dig_obstacles_save_poses(&p->world.bodies->obstacles, bed);
    }
    return status;
}

// Makes the world again with the layers' materials. Contact histories begin at zero, as in a dig.
static enum dig_status apply_layers(struct pour *const p, struct dig_error *const error)
{
    struct dig_bed        bed    = { 0 };
    const enum dig_status status = copy_bed(p, p->types.material, &bed);
    if (status != DIG_OK) {
        return dig_setup_explain(status, error);
    }
    assign_layers(p->scene, &bed);
    dig_setup_finish(&p->world);
    p->world                   = (struct dig_world){ 0 };
    const enum dig_status made = make_world(p, &bed, 0.0, error);
    dig_bed_finish(&bed);
    return made;
}

static enum dig_status settle_and_level(struct pour *const               p,
                                        const struct dig_progress *const progress,
                                        struct dig_error *const          error)
{
    const struct dig_packing *const packing = &p->scene->packing;
    const double                    total_s = packing->settle_s + packing->relax_s;
    enum dig_status status = step_for(&p->world, packing->settle_s, 0.0, total_s, progress);
    if (status != DIG_OK) {
        return dig_setup_explain(status, error);
    }
    if (p->scene->bed.preload_Pa > 0.0) {
        status = dig_level_press(p->scene, &p->world, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (p->scene->bed.layers > 0) {
        status = apply_layers(p, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    status = dig_level_cut(p->scene, &p->world);
    if (status == DIG_OK) {
        status = step_for(&p->world, packing->relax_s, packing->settle_s, total_s, progress);
    }
    return status == DIG_OK ? status : dig_setup_explain(status, error);
}

enum dig_status dig_bed_pour(const struct dig_stepper *const stepper,
                             const struct dig_scene *const   scene,
                             const struct dig_gravel *const gravel, const uint64_t seed,
                             const struct dig_progress *const progress, struct dig_bed *const bed,
                             struct dig_error *const error)
{
    enum dig_status status = dig_setup_check(scene, gravel, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_bed poured = { 0 };
    status                = dig_packing_insert(scene, seed, &poured, error);
    if (status != DIG_OK) {
        return status;
    }
    struct pour p = { .scene = scene, .gravel = gravel };
    if (stepper != NULL) {
        p.stepper = *stepper;
    }
    status = make_world(&p, &poured, scene->packing.fall_mps, error);
    dig_bed_finish(&poured);
    if (status == DIG_OK) {
        status = settle_and_level(&p, progress, error);
    }
    if (status == DIG_OK) {
        const size_t *const material = scene->bed.layers > 0 ? p.types.material : NULL;
        status                       = copy_bed(&p, material, bed);
        status                       = status == DIG_OK ? status : dig_setup_explain(status, error);
    }
    dig_setup_finish(&p.world);
    return status;
}
