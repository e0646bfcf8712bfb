#include "offline_dem/reference/ode_bed.h"

#include "offline_dem/law/law_general.h"
#include "offline_dem/reference/ode_history.h"
#include "offline_dem/shapes/plate_contacts.h"
#include "offline_dem/world/bodies.h"

#include <assert.h>
#include <math.h>
#include <ode/ode.h>
#include <stdlib.h>

// Numbers of walls, rocks and plates in the contact history, beyond any grain's.
#define WALL_NUMBER  0xFFFF0000U
#define ROCK_NUMBER  0xFFFF4000U
#define PLATE_NUMBER 0xFFFF8000U

struct bed {
    struct dig_world *of; // whose grains these are
    dWorldID          world;
    dSpaceID          grains, walls, rocks;
    dGeomID           tool_box;
    dBodyID          *body; // [grains]
    dGeomID           rock_geom[DIG_OBSTACLES_MAX];

    struct dig_ode_history history;
    double                 kick_fraction; // of a kick, in the step under way
    bool                   out_of_memory;
};

// Which grain, wall or rock a geometry is.
static void set_index(dGeomID geom, const size_t index)
{
    dGeomSetData(geom, (void *)(uintptr_t)index); // NOLINT(performance-no-int-to-ptr)
}

static size_t index_of(dGeomID geom)
{
    return (size_t)(uintptr_t)dGeomGetData(geom);
}

static struct dig_motion motion_of(dBodyID body)
{
    struct dig_motion  motion = { 0 };
    const dReal *const x      = dBodyGetPosition(body);
    const dReal *const v      = dBodyGetLinearVel(body);
    const dReal *const w      = dBodyGetAngularVel(body);
    for (int k = 0; k < 3; k++) {
        motion.x_m[k]     = x[k];
        motion.v_mps[k]   = v[k];
        motion.w_radps[k] = w[k];
    }
    return motion;
}

// Of a grain and another, or NULL: what is at rest; d apart.
static struct dig_kinematics between(dBodyID i, dBodyID j, const double d[3])
{
    const struct dig_motion a = motion_of(i);
    const struct dig_motion b = j != NULL ? motion_of(j) : (struct dig_motion){ 0 };
    struct dig_kinematics   t = dig_motion_between(&a, &b);
    t.dx_m                    = d[0];
    t.dy_m                    = d[1];
    t.dz_m                    = d[2];
    return t;
}

// The law's force, which acts on grain i; scaled by the fraction of a kick.
static struct dig_contact_force push(const struct bed *const bed, const size_t i,
                                     const struct dig_law *const        law,
                                     const struct dig_kinematics *const t,
                                     struct dig_contact_history *const  history)
{
    const struct dig_contact_force p = dig_law_apply(law, bed->of->dt_s, t, history);
    const double                   s = bed->kick_fraction;
    dBodyAddForce(bed->body[i], s * p.fx_N, s * p.fy_N, s * p.fz_N);
    dBodyAddTorque(bed->body[i], s * p.ix_Nm, s * p.iy_Nm, s * p.iz_Nm);
    return p;
}

static void add_reaction(const struct dig_contact_force *const p, const double arm_m[3],
                         struct dig_wrench *const sum)
{
    const double f[3] = { p->fx_N, p->fy_N, p->fz_N };
    const double t[3] = { p->jx_Nm, p->jy_Nm, p->jz_Nm };
    dig_wrench_react(f, t, arm_m, sum);
}

// A grain at x_m and a rock d apart: the rock's surface moves. The arm from its centre.
static void move_surface(const struct dig_rock *const rock, const dReal x_m[],
                         struct dig_kinematics *const t, double arm_m[3])
{
    const double *const w = rock->w_radps;
    const double *const v = rock->v_mps;
    arm_m[0]              = x_m[0] - t->dx_m - rock->surface.x_m[0];
    arm_m[1]              = x_m[1] - t->dy_m - rock->surface.x_m[1];
    arm_m[2]              = x_m[2] - t->dz_m - rock->surface.x_m[2];
    t->vx_mps -= v[0] + w[1] * arm_m[2] - w[2] * arm_m[1];
    t->vy_mps -= v[1] + w[2] * arm_m[0] - w[0] * arm_m[2];
    t->vz_mps -= v[2] + w[0] * arm_m[1] - w[1] * arm_m[0];
    t->jx_radps = w[0];
    t->jy_radps = w[1];
    t->jz_radps = w[2];
}

// The law's i is the grain; of two the one of the lower type, as in the kernel.
static bool comes_second(const struct bed *const bed, dGeomID a, dGeomID b)
{
    const uint8_t *const type_of = bed->of->grains.type_of;
    const size_t         i       = index_of(a);
    const size_t         j       = index_of(b);
    return dGeomGetSpace(a) != bed->grains ||
           (dGeomGetSpace(b) == bed->grains &&
            (type_of[i] > type_of[j] || (type_of[i] == type_of[j] && i > j)));
}

// A grain and another, a wall or a rock, whose boxes overlap. Called back by ODE.
static void touch(void *const data, dGeomID a, dGeomID b)
{
    struct bed *const              bed    = data;
    const struct dig_grains *const g      = &bed->of->grains;
    const bool                     second = comes_second(bed, a, b);
    dGeomID                        first  = second ? b : a;
    dGeomID                        other  = second ? a : b;
    const size_t                   i      = index_of(first);
    const size_t                   k      = index_of(other);
    dSpaceID                       space  = dGeomGetSpace(other);
    dBodyID                        j      = space == bed->grains ? bed->body[k] : NULL;
    struct dig_rock *const rock = space == bed->rocks ? &bed->of->bodies->obstacles.rock[k] : NULL;
    const struct dig_law *const law =
        j != NULL ? &bed->of->pair_law[g->type_of[i] * DIG_GRAIN_TYPES_MAX + g->type_of[k]]
                  : &bed->of->wall_law[g->type_of[i]];
    dContactGeom contact;
    if (dCollide(first, other, 1, &contact, sizeof contact) == 0) {
        return;
    }
    const uint32_t number = (j != NULL      ? 0
                             : rock != NULL ? ROCK_NUMBER
                                            : WALL_NUMBER) +
                            (uint32_t)k;
    struct dig_contact_history *const history =
        dig_ode_history_of(&bed->history, (uint32_t)i, number);
    if (history == NULL) {
        bed->out_of_memory = true;
        return;
    }
    const double          d_m  = law->reach_m - contact.depth;
    const double          d[3] = { d_m * contact.normal[0], d_m * contact.normal[1],
                                   d_m * contact.normal[2] };
    struct dig_kinematics t    = between(bed->body[i], j, d);
    double                arm_m[3];
    if (rock != NULL) {
        move_surface(rock, dBodyGetPosition(bed->body[i]), &t, arm_m);
    }
    const struct dig_contact_force p = push(bed, i, law, &t, history);
    if (rock != NULL) {
        add_reaction(&p, arm_m, &rock->load);
    }
    if (j != NULL) {
        const double s = bed->kick_fraction;
        dBodyAddForce(j, -s * p.fx_N, -s * p.fy_N, -s * p.fz_N);
        dBodyAddTorque(j, s * p.jx_Nm, s * p.jy_Nm, s * p.jz_Nm);
    }
}

// One contact of a grain with the tool.
static void touch_plate(const struct bed *const bed, const size_t i, const double body_m[3],
                        const double closest_m[3], struct dig_contact_history *const history)
{
    struct dig_world *const w = bed->of;
    double                  d[3];
    double                  arm_m[3];
    double                  v_mps[3];
    dig_tool_separation(w->tool, body_m, closest_m, d, arm_m, v_mps);
    struct dig_kinematics t = between(bed->body[i], NULL, d);
    t.vx_mps -= v_mps[0];
    t.vz_mps -= v_mps[2];
    const struct dig_contact_force p =
        push(bed, i, &w->tool_law[w->grains.type_of[i]], &t, history);
    add_reaction(&p, arm_m, &w->on_tool);
}

// A grain in the box about the tool. Called back by ODE.
static void touch_tool(void *const data, dGeomID a, dGeomID b)
{
    struct bed *const              bed      = data;
    const struct dig_grains *const g        = &bed->of->grains;
    const struct dig_tool *const   tool     = bed->of->tool;
    const size_t                   i        = index_of(a == bed->tool_box ? b : a);
    const double                   radius_m = g->type[g->type_of[i]].radius_m;
    struct dig_plate_contacts      near;
    double                         body_m[3];
    dig_tool_to_body(tool, dBodyGetPosition(bed->body[i]), body_m);
    near.count = 0;
    for (size_t plate = 0; plate < tool->plates; plate++) {
        if (!dig_plate_contacts_add(&tool->bucket, plate, body_m, radius_m, &near)) {
            near.count--;
            continue;
        }
        const struct dig_contact_history *const was =
            dig_ode_history_previous(&bed->history, (uint32_t)i, PLATE_NUMBER + (uint32_t)plate);
        near.history[near.count - 1] = was != NULL ? *was : (struct dig_contact_history){ 0 };
    }
    dig_plate_contacts_resolve(&tool->bucket, radius_m, &near);
    for (size_t k = 0; k < near.count; k++) {
        if (!near.touched[k]) {
            continue;
        }
        touch_plate(bed, i, body_m, near.closest_m[k], &near.history[k]);
        struct dig_contact_history *const kept =
            dig_ode_history_of(&bed->history, (uint32_t)i, PLATE_NUMBER + (uint32_t)near.plate[k]);
        bed->out_of_memory = bed->out_of_memory || kept == NULL;
        if (kept != NULL) {
            *kept = near.history[k];
        }
    }
}

// The box around the tool: grains whose boxes overlap it may touch the tool.
static void place_box(const struct dig_tool *const tool, dGeomID box)
{
    double low[3]  = { INFINITY, 0.0, INFINITY };
    double high[3] = { -INFINITY, 0.0, -INFINITY };
    for (size_t k = 0; k < tool->bucket.points; k++) {
        const double body[3] = { tool->bucket.x_m[k], 0.0, tool->bucket.z_m[k] };
        double       world[3];
        dig_tool_rotate(tool, body, world);
        low[0]  = fmin(low[0], world[0]);
        low[2]  = fmin(low[2], world[2]);
        high[0] = fmax(high[0], world[0]);
        high[2] = fmax(high[2], world[2]);
    }
    dGeomBoxSetLengths(box, high[0] - low[0], tool->bucket.width_m, high[2] - low[2]);
    dGeomSetPosition(box, tool->pose.x_m + 0.5 * (low[0] + high[0]), 0.0,
                     tool->pose.z_m + 0.5 * (low[2] + high[2]));
}

// Poses of the rocks at present, without loads.
static void place_rocks(const struct bed *const bed)
{
    for (size_t r = 0; r < dig_bodies_rocks(bed->of->bodies); r++) {
        struct dig_rock *const rock = &bed->of->bodies->obstacles.rock[r];
        const double *const    x    = rock->surface.x_m;
        rock->load                  = (struct dig_wrench){ 0 };
        dGeomSetPosition(bed->rock_geom[r], x[0], x[1], x[2]);
        dGeomSetQuaternion(bed->rock_geom[r], rock->surface.q);
    }
}

static enum dig_status step(struct dig_world *const w)
{
    struct bed *const bed = w->stand_in_own;
    bed->kick_fraction    = w->started ? 1.0 : 0.5;
    w->on_tool            = (struct dig_wrench){ 0 };
    place_rocks(bed);
    dSpaceCollide(bed->grains, bed, touch);
    dSpaceCollide2((dGeomID)bed->grains, (dGeomID)bed->walls, bed, touch);
    dSpaceCollide2((dGeomID)bed->grains, (dGeomID)bed->rocks, bed, touch);
    if (w->tool != NULL) {
        place_box(w->tool, bed->tool_box);
        dSpaceCollide2((dGeomID)bed->grains, bed->tool_box, bed, touch_tool);
    }
    dig_ode_history_end_step(&bed->history);
    const double *const g = w->gravity_mps2;
    dWorldSetGravity(bed->world, bed->kick_fraction * g[0], bed->kick_fraction * g[1],
                     bed->kick_fraction * g[2]);
    if (bed->out_of_memory || !dWorldQuickStep(bed->world, w->dt_s)) {
        return DIG_ENOMEM;
    }
    if (w->bodies != NULL && w->bodies->ode != NULL) {
        dig_ode_rocks_step(w->bodies->ode, w->tool, w->bodies->rock_law, w->dt_s,
                           w->bodies->obstacles.rock, &w->on_tool);
    }
    dig_wrench_add(&w->on_tool, &w->sum_tool);
    w->started = true;
    w->steps++;
    return DIG_OK;
}

// Nobody writes motions: nothing is dug before, and no grain is taken away.
static enum dig_status sync(struct dig_world *const w, const bool all)
{
    assert(!all);
    const struct bed *const bed = w->stand_in_own;
    for (size_t i = 0; i < w->grains.n; i++) {
        w->grains.motion[i] = motion_of(bed->body[i]);
    }
    return DIG_OK;
}

static void destroy(struct dig_world *const w)
{
    struct bed *const bed = w->stand_in_own;
    dGeomDestroy(bed->tool_box);
    dSpaceDestroy(bed->grains);
    dSpaceDestroy(bed->walls);
    dSpaceDestroy(bed->rocks);
    dWorldDestroy(bed->world);
    dCloseODE();
    dig_ode_history_finish(&bed->history);
    free(bed->body);
    free(bed);
}

static void add_grain(const struct bed *const bed, const struct dig_grain_type *const type,
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
    dGeomID geom = dCreateSphere(bed->grains, type->radius_m);
    dGeomSetBody(geom, bed->body[i]);
    set_index(geom, i);
}

// Cells from the smallest to the largest grain: the default levels are for metres, and ten times
// slower here.
static void make_spaces(struct bed *const bed, const struct dig_grains *const grains)
{
    double least_m = INFINITY;
    double most_m  = 0.0;
    for (size_t k = 0; k < grains->types; k++) {
        least_m = fmin(least_m, 2.0 * grains->type[k].radius_m);
        most_m  = fmax(most_m, 2.0 * grains->type[k].radius_m);
    }
    bed->grains = dHashSpaceCreate(NULL);
    dHashSpaceSetLevels(bed->grains, (int)floor(log2(least_m)), (int)ceil(log2(most_m)));
    bed->walls    = dSimpleSpaceCreate(NULL);
    bed->rocks    = dSimpleSpaceCreate(NULL);
    bed->tool_box = dCreateBox(NULL, 1.0, 1.0, 1.0);
}

static void add_surfaces(struct bed *const bed, const struct dig_world *const w)
{
    for (size_t k = 0; k < w->walls; k++) {
        const double *const n = w->wall[k].normal;
        set_index(dCreatePlane(bed->walls, n[0], n[1], n[2], w->wall[k].offset_m), k);
    }
    for (size_t r = 0; r < dig_bodies_rocks(w->bodies); r++) {
        bed->rock_geom[r] = dig_ode_rocks_shape(bed->rocks, &w->bodies->obstacles.rock[r].surface);
        set_index(bed->rock_geom[r], r);
    }
}

enum dig_status dig_ode_bed_take_over(struct dig_world *const w)
{
    static const struct dig_stand_in stand_in = { step, sync, destroy };
    if (w->bodies != NULL && w->bodies->clumps > 0) {
        return DIG_EINVAL;
    }
    struct bed *const bed  = calloc(1, sizeof *bed);
    dBodyID *const    body = calloc(w->grains.n + 1, sizeof(dBodyID));
    if (bed == NULL || body == NULL || !dInitODE2(0)) {
        free(bed);
        free(body);
        return DIG_ENOMEM;
    }
    bed->of    = w;
    bed->body  = body;
    bed->world = dWorldCreate();
    make_spaces(bed, &w->grains);
    for (size_t i = 0; i < w->grains.n; i++) {
        add_grain(bed, &w->grains.type[w->grains.type_of[i]], &w->grains.motion[i], i);
    }
    add_surfaces(bed, w);
    w->stand_in     = &stand_in;
    w->stand_in_own = bed;
    return DIG_OK;
}
