#include "offline_dem/reference/ode_bed.h"

#include "offline_dem/reference/ode_contacts.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The box around the tool: grains whose boxes overlap it may touch the tool.
static void place_box(const struct dig_ode_bed *const bed)
{
    const struct dig_tool *const tool    = bed->tool;
    double                       low[3]  = { INFINITY, 0.0, INFINITY };
    double                       high[3] = { -INFINITY, 0.0, -INFINITY };
    for (size_t k = 0; k < tool->bucket.points; k++) {
        const double body[3] = { tool->bucket.x_m[k], 0.0, tool->bucket.z_m[k] };
        double       world[3];
        dig_tool_rotate(tool, body, world);
        low[0]  = fmin(low[0], world[0]);
        low[2]  = fmin(low[2], world[2]);
        high[0] = fmax(high[0], world[0]);
        high[2] = fmax(high[2], world[2]);
    }
    dGeomBoxSetLengths(bed->tool_box, high[0] - low[0], tool->bucket.width_m, high[2] - low[2]);
    dGeomSetPosition(bed->tool_box, tool->pose.x_m + 0.5 * (low[0] + high[0]), 0.0,
                     tool->pose.z_m + 0.5 * (low[2] + high[2]));
}

// Poses of the rocks at present, without loads.
static void place_rocks(struct dig_ode_bed *const bed)
{
    for (size_t r = 0; r < bed->rocks; r++) {
        struct dig_rock *const rock = &bed->rock[r];
        const double *const    x    = rock->surface.x_m;
        rock->load                  = (struct dig_wrench){ 0 };
        dGeomSetPosition(bed->rock_geom[r], x[0], x[1], x[2]);
        dGeomSetQuaternion(bed->rock_geom[r], rock->surface.q);
    }
}

enum dig_status dig_ode_bed_step(struct dig_ode_bed *const bed, const struct dig_tool *const tool,
                                 struct dig_wrench *const on_tool)
{
    bed->tool          = tool;
    bed->on_tool       = (struct dig_wrench){ 0 };
    bed->kick_fraction = bed->started ? 1.0 : 0.5;
    dSpaceCollide(bed->grains_space, bed, dig_ode_contacts_grain);
    dSpaceCollide2((dGeomID)bed->grains_space, (dGeomID)bed->walls_space, bed,
                   dig_ode_contacts_wall);
    place_rocks(bed);
    dSpaceCollide2((dGeomID)bed->grains_space, (dGeomID)bed->rocks_space, bed,
                   dig_ode_contacts_rock);
    if (tool != NULL) {
        place_box(bed);
        dSpaceCollide2((dGeomID)bed->grains_space, bed->tool_box, bed, dig_ode_contacts_tool);
    }
    dig_ode_history_end_step(&bed->history);
    if (bed->out_of_memory) {
        return DIG_ENOMEM;
    }
    const double *const g = bed->gravity_mps2;
    dWorldSetGravity(bed->world, bed->kick_fraction * g[0], bed->kick_fraction * g[1],
                     bed->kick_fraction * g[2]);
    if (!dWorldQuickStep(bed->world, bed->dt_s)) {
        return DIG_ENOMEM;
    }
    if (bed->scene != NULL) {
        dig_ode_rocks_step(bed->scene, tool, bed->rock_law, bed->dt_s, bed->rock, &bed->on_tool);
    }
    bed->started = true;
    *on_tool     = bed->on_tool;
    return DIG_OK;
}

struct dig_motion dig_ode_bed_motion(const struct dig_ode_bed *const bed, const size_t grain)
{
    return dig_ode_contacts_motion(bed->body[grain]);
}

static void add_grain(struct dig_ode_bed *const bed, const struct dig_grain_type *const type,
                      const struct dig_motion *const m, const size_t i)
{
    bed->body[i] = dBodyCreate(bed->world);
    dMass mass;
    dMassSetParameters(&mass, type->mass_kg, 0.0, 0.0, 0.0, type->inertia_kgm2, type->inertia_kgm2,
                       type->inertia_kgm2, 0.0, 0.0, 0.0);
    dBodySetMass(bed->body[i], &mass);
    dBodySetPosition(bed->body[i], m->x_m[0], m->x_m[1], m->x_m[2]);
    dBodySetLinearVel(bed->body[i], m->v_mps[0], m->v_mps[1], m->v_mps[2]);
    dBodySetAngularVel(bed->body[i], m->w_radps[0], m->w_radps[1], m->w_radps[2]);
    dBodySetGyroscopicMode(bed->body[i], 0);
    bed->grain_geom[i] = dCreateSphere(bed->grains_space, type->radius_m);
    dGeomSetBody(bed->grain_geom[i], bed->body[i]);
    dGeomSetData(bed->grain_geom[i], (void *)(uintptr_t)i); // NOLINT(performance-no-int-to-ptr)
}

// Cells from the smallest to the largest grain: the default levels are for metres, and ten times
// slower here.
static void make_space(struct dig_ode_bed *const bed, const struct dig_grains *const grains)
{
    double least_m = INFINITY;
    double most_m  = 0.0;
    for (size_t k = 0; k < grains->types; k++) {
        least_m = fmin(least_m, 2.0 * grains->type[k].radius_m);
        most_m  = fmax(most_m, 2.0 * grains->type[k].radius_m);
    }
    bed->grains_space = dHashSpaceCreate(NULL);
    dHashSpaceSetLevels(bed->grains_space, (int)floor(log2(least_m)), (int)ceil(log2(most_m)));
    bed->walls_space = dSimpleSpaceCreate(NULL);
    bed->rocks_space = dSimpleSpaceCreate(NULL);
    bed->tool_box    = dCreateBox(NULL, 1.0, 1.0, 1.0);
}

static void add_rocks(struct dig_ode_bed *const bed, const struct dig_bodies *const bodies)
{
    bed->rocks = bodies->obstacles.rocks;
    bed->scene = bodies->ode;
    memcpy(bed->rock, bodies->obstacles.rock, sizeof bed->rock);
    memcpy(bed->rock_law, bodies->rock_law, sizeof bed->rock_law);
    for (size_t r = 0; r < bed->rocks; r++) {
        const double *const h = bed->rock[r].surface.half_m;
        bed->rock_geom[r]     = bed->rock[r].surface.shape == DIG_OBSTACLE_BOX
                                    ? dCreateBox(bed->rocks_space, 2.0 * h[0], 2.0 * h[1], 2.0 * h[2])
                                    : dCreateSphere(bed->rocks_space, h[0]);
        dGeomSetData(bed->rock_geom[r], (void *)(uintptr_t)r); // NOLINT(performance-no-int-to-ptr)
    }
}

struct dig_ode_bed *dig_ode_bed_create(const struct dig_world *const world)
{
    if (world->bodies != NULL && world->bodies->clumps > 0) {
        return NULL;
    }
    const struct dig_grains *const grains = &world->grains;
    struct dig_ode_bed *const      bed    = calloc(1, sizeof *bed);
    if (bed == NULL || !dInitODE2(0)) {
        free(bed);
        return NULL;
    }
    bed->n     = grains->n;
    bed->world = dWorldCreate();
    make_space(bed, grains);
    bed->dt_s = world->dt_s;
    memcpy(bed->gravity_mps2, world->gravity_mps2, sizeof bed->gravity_mps2);
    memcpy(bed->type, grains->type, sizeof bed->type);
    memcpy(bed->pair_law, world->pair_law, sizeof bed->pair_law);
    memcpy(bed->wall_law, world->wall_law, sizeof bed->wall_law);
    memcpy(bed->tool_law, world->tool_law, sizeof bed->tool_law);
    bed->body       = calloc(bed->n + 1, sizeof(dBodyID));
    bed->grain_geom = calloc(bed->n + 1, sizeof(dGeomID));
    bed->type_of    = calloc(bed->n + 1, sizeof *bed->type_of);
    if (bed->body == NULL || bed->grain_geom == NULL || bed->type_of == NULL) {
        dig_ode_bed_destroy(bed);
        return NULL;
    }
    memcpy(bed->type_of, grains->type_of, bed->n * sizeof *bed->type_of);
    for (size_t i = 0; i < bed->n; i++) {
        add_grain(bed, &grains->type[grains->type_of[i]], &grains->motion[i], i);
    }
    for (size_t k = 0; k < world->walls; k++) {
        const struct dig_wall *const wall = &world->wall[k];
        dGeomID plane = dCreatePlane(bed->walls_space, wall->normal[0], wall->normal[1],
                                     wall->normal[2], wall->offset_m);
        dGeomSetData(plane, (void *)(uintptr_t)k); // NOLINT(performance-no-int-to-ptr)
    }
    if (world->bodies != NULL) {
        add_rocks(bed, world->bodies);
    }
    return bed;
}

void dig_ode_bed_destroy(struct dig_ode_bed *const bed)
{
    if (bed == NULL) {
        return;
    }
    dGeomDestroy(bed->tool_box);
    dSpaceDestroy(bed->grains_space);
    dSpaceDestroy(bed->walls_space);
    dSpaceDestroy(bed->rocks_space);
    dWorldDestroy(bed->world);
    dCloseODE();
    dig_ode_history_finish(&bed->history);
    free(bed->body);
    free(bed->grain_geom);
    free(bed->type_of);
    free(bed);
}
