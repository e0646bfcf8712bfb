#include "offline_dem/dig/setup.h"

#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/ode_scene.h"

#include <math.h>
#include <stdlib.h>

enum dig_status dig_setup_check(const struct dig_scene *const  scene,
                                const struct dig_gravel *const gravel,
                                struct dig_error *const        error)
{
    struct dig_conditions c = { .status = dig_scene_check(scene, error), .error = error };
    for (int a = 0; a < DIG_AXES; a++) {
        const double value   = gravel->value[a];
        const bool   density = a == DIG_AXIS_DENSITY_kgpm3;
        dig_require(&c, isfinite(value) && (density ? value > 0.0 : value >= 0.0),
                    "%s: %g, expected %s", dig_axis_name((enum dig_axis)a), value,
                    density ? "> 0" : ">= 0");
    }
    return c.status;
}

// Counts of steps stay far below what an integer holds.
#define LEAST_STEP_s 1e-12

static enum dig_status make_grains(const struct dig_scene *const       scene,
                                   const struct dig_bed *const         bed,
                                   const struct dig_clump_shape *const shape, const double fall_mps,
                                   const struct dig_grain_types *const types,
                                   const uint8_t type_of[], struct dig_grains *const grains,
                                   struct dig_bodies **const bodies)
{
    enum dig_status status = dig_grains_create(types->types, types->type, bed->grains, bed->x_m,
                                               bed->y_m, bed->z_m, type_of, grains);
    if (status == DIG_OK) {
        for (size_t i = 0; i < bed->grains; i++) {
            grains->motion[i].v_mps[2] = -fall_mps;
        }
        status = dig_bodies_create(scene, bed, shape, types->contact_kg, fall_mps, grains, bodies);
        if (status != DIG_OK) {
            dig_grains_finish(grains);
        }
    }
    return status;
}

enum dig_status dig_setup_world(const struct dig_scene *const  scene,
                                const struct dig_gravel *const gravel,
                                const struct dig_bed *const bed, const double fall_mps,
                                struct dig_grain_types *const types, struct dig_world *const world,
                                struct dig_error *const error)
{
    struct dig_clump_shape shape   = { 0 };
    struct dig_grain_types found   = { 0 };
    struct dig_grains      grains  = { 0 };
    struct dig_bodies     *bodies  = NULL;
    uint8_t *const         type_of = calloc(bed->grains + 1, 1);
    struct dig_ode_scene  *ode     = dig_ode_scene_create(scene);
    enum dig_status        status  = dig_clump_shape_make(&scene->bed.clump, &shape);
    if (status != DIG_OK) {
        status = dig_error_set(error, status, "bed.clump: no volume, expected some");
    } else if (type_of == NULL || ode == NULL) {
        status = dig_setup_explain(DIG_ENOMEM, error);
    } else {
        status = dig_grain_types_find(scene, gravel, bed, &shape, &found, type_of, error);
    }
    const double dt_s = dig_grain_types_time_step_s(scene, gravel, &found);
    if (status == DIG_OK && !(dt_s >= LEAST_STEP_s)) {
        status =
            dig_error_set(error, DIG_EINVAL, "time_step_s: %g%s, expected at least %g", dt_s,
                          scene->time_step_s > 0.0 ? "" : " by material and bed", LEAST_STEP_s);
    }
    if (status == DIG_OK && type_of != NULL) {
        status = make_grains(scene, bed, &shape, fall_mps, &found, type_of, &grains, &bodies);
        if (status == DIG_EINVAL) {
            status = dig_error_set(error, status,
                                   "bed: a grain whose position is no number, expected numbers");
        } else if (status != DIG_OK) {
            status = dig_setup_explain(status, error);
        }
    }
    free(type_of);
    if (status != DIG_OK) {
        dig_ode_scene_destroy(ode);
        return status;
    }
    struct dig_world made = {
        .dt_s         = dt_s,
        .gravity_mps2 = { 0.0, 0.0, -scene->gravity_mps2 },
        .isa          = dig_kernel_best(),
        .bodies       = bodies,
        .ode          = ode,
        .period_y_m   = dig_scene_period_m(scene),
    };
    made.walls = dig_ode_scene_walls(ode, made.wall);
    dig_world_init(&made, &grains);
    dig_grain_types_set_laws(scene, gravel, &found, &made);
    if (bodies != NULL) {
        const struct dig_law_material walls =
            dig_grain_types_between(scene, gravel, 0, DIG_MATERIAL_WALLS);
        dig_bodies_release_rocks(bodies, ode, &walls);
    }
    if (types != NULL) {
        *types = found;
    }
    *world = made;
    return DIG_OK;
}

// Fewer grains are one slab (dig_grains_set_slabs()), which one thread steps while the others wait.
static const size_t least_to_share = 32768;

enum dig_status dig_setup_stepper(const struct dig_stepper *const stepper,
                                  struct dig_world *const world, struct dig_error *const error)
{
    world->single          = stepper->single_precision;
    enum dig_status status = DIG_OK;
    if (stepper->take_over != NULL) {
        status = stepper->take_over(world, error);
    }
    if (status == DIG_OK && stepper->threads > 1 && world->grains.n >= least_to_share) {
        status = dig_crew_create(stepper->threads, &world->crew);
    }
    return status == DIG_ENOMEM ? dig_setup_explain(status, error) : status;
}

void dig_setup_finish(struct dig_world *const world)
{
    dig_bodies_destroy(world->bodies);
    world->bodies = NULL;
    dig_crew_destroy(world->crew);
    world->crew = NULL;
    dig_ode_scene_destroy(world->ode);
    world->ode = NULL;
    dig_world_finish(world);
}

enum dig_status dig_setup_explain(const enum dig_status status, struct dig_error *const error)
{
    switch (status) {
    case DIG_EINVAL:
        return dig_error_set(
            error, status,
            "time_step_s: the grains' positions grew beyond all bounds, expected a "
            "shorter step");
    case DIG_EUNREACHABLE:
        return dig_error_set(error, status,
                             "packing.solid_fraction: the grains do not fit, expected less");
    case DIG_ESTALE: return dig_error_set(error, status, "stopped before its end");
    case DIG_OK:
    case DIG_ENOMEM:
        return dig_error_set(error, status,
                             "out of memory, expected a smaller box_m or a larger "
                             "material.diameter_m");
    case DIG_ENOMATCH:
    case DIG_ESCHEMA:
    case DIG_EIO: break;
    }
    return dig_error_set(error, status, "%s", dig_status_str(status));
}
