#include "offline_dem/world/bodies.h"

#include "offline_dem/law/period.h"
#include "offline_dem/world/surfaces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A clump at the positions of its spheres, falling without rotation. Spheres beyond a periodic side
// are moved to the image nearest to the first.
static void place_clump(const double period_m, const struct dig_clump_shape *const shape,
                        const struct dig_bed *const bed, const size_t first, const double mass_kg,
                        const double fall_mps, struct dig_clump_body *const clump)
{
    double at_m[DIG_CLUMP_MAX][3];
    double rotation[3][3];
    for (size_t k = 0; k < shape->spheres; k++) {
        at_m[k][0]       = bed->x_m[first + k];
        at_m[k][1]       = bed->y_m[first] + dig_period_fold(bed->y_m[first + k] - bed->y_m[first],
                                                             period_m, dig_period_inverse(period_m));
        at_m[k][2]       = bed->z_m[first + k];
        clump->member[k] = (uint32_t)(first + k);
    }
    clump->unit_m       = bed->radius_m[first] / shape->radius[0];
    clump->body.mass_kg = mass_kg;
    dig_clump_orientation(shape, (const double(*)[3])at_m, rotation);
    dig_rigid_quaternion((const double(*)[3])rotation, clump->body.q);
    double arm[3];
    dig_rigid_rotate(clump->body.q, shape->at[0], arm);
    for (int r = 0; r < 3; r++) {
        clump->body.x_m[r] = at_m[0][r] - clump->unit_m * arm[r];
        for (int c = 0; c < 3; c++) {
            clump->body.inverse_pkgm2[r][c] =
                shape->inverse[r][c] / (mass_kg * clump->unit_m * clump->unit_m);
        }
    }
    clump->body.v_mps[2] = -fall_mps;
}

enum dig_status dig_bodies_create(const struct dig_scene *const       scene,
                                  const struct dig_bed *const         bed,
                                  const struct dig_clump_shape *const shape,
                                  const double clump_kg[], const double fall_mps,
                                  struct dig_grains *const grains, struct dig_bodies **const bodies)
{
    if (shape->spheres == 0 && scene->bed.obstacles == 0) {
        *bodies = NULL;
        return DIG_OK;
    }
    const size_t             clumps   = shape->spheres > 0 ? bed->grains / shape->spheres : 0;
    struct dig_bodies *const made     = calloc(1, sizeof *made);
    struct dig_clump_body   *clump    = calloc(clumps + 1, sizeof *clump);
    uint32_t *const          clump_of = calloc(bed->grains + 1, sizeof *clump_of);
    if (made == NULL || clump == NULL || clump_of == NULL) {
        free(made);
        free(clump);
        free(clump_of);
        return DIG_ENOMEM;
    }
    *made = (struct dig_bodies){
        .shape = *shape, .clumps = clumps, .clump = clump, .obstacles = dig_obstacles_make(scene)
    };
    dig_obstacles_load_poses(&made->obstacles, bed);
    for (size_t b = 0; b < clumps; b++) {
        const size_t first = b * shape->spheres;
        place_clump(dig_scene_period_m(scene), shape, bed, first, clump_kg[grains->type_of[first]],
                    fall_mps, &clump[b]);
        for (size_t k = 0; k < shape->spheres; k++) {
            clump_of[first + k] = (uint32_t)(b + 1);
        }
    }
    if (clumps > 0) {
        grains->clump = clump_of;
    } else {
        free(clump_of);
    }
    *bodies = made;
    return DIG_OK;
}

void dig_bodies_destroy(struct dig_bodies *const bodies)
{
    if (bodies == NULL) {
        return;
    }
    free(bodies->clump);
    free(bodies);
}

static void step_clump(struct dig_world *const world, const struct dig_clump_shape *const shape,
                       struct dig_clump_body *const clump)
{
    struct dig_load load[DIG_CLUMP_MAX];
    for (size_t k = 0; k < shape->spheres; k++) {
        load[k] = world->grains.load[clump->member[k]];
    }
    dig_clump_step(shape, load, world->gravity_mps2,
                   world->started ? world->dt_s : 0.5 * world->dt_s, world->dt_s, clump,
                   world->grains.motion);
}

void dig_bodies_apply_loads(struct dig_world *const world)
{
    struct dig_bodies *const bodies = world->bodies;
    if (bodies->obstacles.rocks > 0) {
        dig_surfaces_add_rock_loads(world);
    }
    for (size_t b = 0; b < bodies->clumps; b++) {
        if (!bodies->clump[b].gone) {
            step_clump(world, &bodies->shape, &bodies->clump[b]);
        }
    }
}

void dig_bodies_release_rocks(struct dig_bodies *const bodies, struct dig_ode_scene *const ode,
                              const struct dig_law_material *const material)
{
    struct dig_obstacles *const o = &bodies->obstacles;
    for (size_t i = 0; i < o->rocks; i++) {
        const struct dig_rock *const rock = &o->rock[i];
        if (!rock->movable) {
            continue;
        }
        bodies->rock_law[i] =
            dig_law_wall(material, dig_rock_least_half_m(&rock->surface), rock->mass_kg);
        bodies->ode = ode;
    }
    if (bodies->ode != NULL) {
        dig_ode_rocks_set(ode, o->rocks, o->rock);
    }
}

void dig_bodies_step_rocks(struct dig_world *const world)
{
    struct dig_bodies *const bodies = world->bodies;
    if (bodies->ode != NULL) {
        dig_ode_rocks_step(bodies->ode, world->tool, bodies->rock_law, world->dt_s,
                           bodies->obstacles.rock, &world->on_tool);
        world->stale = world->stale || dig_obstacles_left_margin(&bodies->obstacles);
    }
}

void dig_bodies_renumber(struct dig_bodies *const bodies, const uint32_t new_index[])
{
    if (bodies == NULL) {
        return;
    }
    for (size_t b = 0; b < bodies->clumps; b++) {
        struct dig_clump_body *const clump = &bodies->clump[b];
        for (size_t k = 0; k < bodies->shape.spheres && !clump->gone; k++) {
            clump->member[k] = new_index[clump->member[k]];
            clump->gone      = clump->member[k] == UINT32_MAX;
        }
    }
}
