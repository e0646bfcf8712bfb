#include "offline_dem/ode_bed.h"

#include "offline_dem/law_general.h"
#include "offline_dem/ode_memory.h"
#include "offline_dem/ode_touch.h"

#include <math.h>
#include <ode/ode.h>
#include <stdlib.h>
#include <string.h>

// Numbers of walls and plates in contact memory, beyond any grain's.
#define WALL_NUMBER 0xFFFF0000U

struct dig_ode_bed {
    dWorldID world;
    dSpaceID grains_space, walls_space;
    dGeomID  tool_box;
    size_t   n;
    dBodyID *body; // [n]
    dGeomID *ball; // [n]
    uint8_t *of;   // [n]

    // Read from the world this was made from.
    double          dt_s, gravity_mps2[3];
    struct dig_kind kind[DIG_KINDS_MAX];
    struct dig_law  pair_law[DIG_KINDS_MAX * DIG_KINDS_MAX], wall_law[DIG_KINDS_MAX],
        tool_law[DIG_KINDS_MAX];

    struct dig_ode_memory memory;
    bool                  started;

    // Of the step under way.
    const struct dig_tool *tool;
    struct dig_wrench      on_tool;
    double                 share; // of a kick
    bool                   short_of_memory;
};

static size_t number_of(const dGeomID geom)
{
    return (size_t)(uintptr_t)dGeomGetData(geom);
}

static void relative(const dBodyID i, const dBodyID j, struct dig_touch *const t)
{
    const dReal *const vi = dBodyGetLinearVel(i);
    const dReal *const wi = dBodyGetAngularVel(i);
    t->vx_mps             = vi[0];
    t->vy_mps             = vi[1];
    t->vz_mps             = vi[2];
    t->ix_radps           = wi[0];
    t->iy_radps           = wi[1];
    t->iz_radps           = wi[2];
    if (j != NULL) {
        const dReal *const vj = dBodyGetLinearVel(j);
        const dReal *const wj = dBodyGetAngularVel(j);
        t->vx_mps -= vj[0];
        t->vy_mps -= vj[1];
        t->vz_mps -= vj[2];
        t->jx_radps = wj[0];
        t->jy_radps = wj[1];
        t->jz_radps = wj[2];
    }
}

static struct dig_push law_of(const struct dig_law *const law, const double dt_s,
                              const struct dig_touch touch, struct dig_memory *const memory)
{
    return law->general ? dig_law_general(*law, dt_s, touch, memory)
                        : dig_law_step(*law, dt_s, touch, memory);
}

// Loads on i, scaled for a kick that is not a whole one.
static void load_first(const struct dig_ode_bed *const bed, const dBodyID i,
                       const struct dig_push *const p)
{
    const double s = bed->share;
    dBodyAddForce(i, s * p->fx_N, s * p->fy_N, s * p->fz_N);
    dBodyAddTorque(i, s * p->ix_Nm, s * p->iy_Nm, s * p->iz_Nm);
}

static void load_second(const struct dig_ode_bed *const bed, const dBodyID j,
                        const struct dig_push *const p)
{
    const double s = bed->share;
    dBodyAddForce(j, -s * p->fx_N, -s * p->fy_N, -s * p->fz_N);
    dBodyAddTorque(j, s * p->jx_Nm, s * p->jy_Nm, s * p->jz_Nm);
}

static void set_distance(struct dig_touch *const t, const dContactGeom *const c,
                         const double reach_m)
{
    const double d_m = reach_m - c->depth;
    t->dx_m          = d_m * c->normal[0];
    t->dy_m          = d_m * c->normal[1];
    t->dz_m          = d_m * c->normal[2];
}

// Two grains whose boxes overlap. The law's i is the one of the lower kind, as in the kernel.
static void meet_grain(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const bed = data;
    const size_t              na  = number_of(a);
    const size_t              nb  = number_of(b);
    if (bed->of[na] > bed->of[nb] || (bed->of[na] == bed->of[nb] && na > nb)) {
        meet_grain(data, b, a);
        return;
    }
    dContactGeom contact;
    if (dCollide(a, b, 1, &contact, sizeof contact) == 0) {
        return;
    }
    const struct dig_law *const law = &bed->pair_law[bed->of[na] * DIG_KINDS_MAX + bed->of[nb]];
    struct dig_memory *const memory = dig_ode_memory_of(&bed->memory, (uint32_t)na, (uint32_t)nb);
    if (memory == NULL) {
        bed->short_of_memory = true;
        return;
    }
    struct dig_touch touch = { 0 };
    set_distance(&touch, &contact, law->reach_m);
    relative(bed->body[na], bed->body[nb], &touch);
    const struct dig_push push = law_of(law, bed->dt_s, touch, memory);
    load_first(bed, bed->body[na], &push);
    load_second(bed, bed->body[nb], &push);
}

static void meet_wall(void *const data, const dGeomID a, const dGeomID b)
{
    struct dig_ode_bed *const bed  = data;
    const bool                swap = dGeomGetClass(a) == dPlaneClass;
    const dGeomID             ball = swap ? b : a;
    const dGeomID             wall = swap ? a : b;
    dContactGeom              contact;
    if (dCollide(ball, wall, 1, &contact, sizeof contact) == 0) {
        return;
    }
    const size_t                i   = number_of(ball);
    const struct dig_law *const law = &bed->wall_law[bed->of[i]];
    struct dig_memory *const    memory =
        dig_ode_memory_of(&bed->memory, (uint32_t)i, WALL_NUMBER + (uint32_t)number_of(wall));
    if (memory == NULL) {
        bed->short_of_memory = true;
        return;
    }
    struct dig_touch touch = { 0 };
    set_distance(&touch, &contact, law->reach_m);
    relative(bed->body[i], NULL, &touch);
    const struct dig_push push = law_of(law, bed->dt_s, touch, memory);
    load_first(bed, bed->body[i], &push);
}

// One contact of a grain with the tool: point and memory are given.
static void push_tool(struct dig_ode_bed *const bed, const size_t i, const double body_m[3],
                      struct dig_ode_touch *const at)
{
    const struct dig_tool *const tool = bed->tool;
    const double away[3] = { body_m[0] - at->closest_m[0], body_m[1] - at->closest_m[1],
                             body_m[2] - at->closest_m[2] };
    double       d[3];
    double       arm[3];
    dig_tool_turn(tool, away, d);
    dig_tool_turn(tool, at->closest_m, arm);
    struct dig_touch touch = { .dx_m = d[0], .dy_m = d[1], .dz_m = d[2] };
    relative(bed->body[i], NULL, &touch);
    touch.vx_mps -= tool->vx_mps - tool->w_radps * arm[2];
    touch.vz_mps -= tool->vz_mps + tool->w_radps * arm[0];
    const struct dig_push p = law_of(&bed->tool_law[bed->of[i]], bed->dt_s, touch, &at->memory);
    load_first(bed, bed->body[i], &p);

    const double             f[3]    = { p.fx_N, p.fy_N, p.fz_N };
    const double             t[3]    = { p.jx_Nm, p.jy_Nm, p.jz_Nm };
    struct dig_wrench *const on_tool = &bed->on_tool;
    for (int k = 0; k < 3; k++) {
        const int next  = (k + 1) % 3;
        const int other = (k + 2) % 3;
        on_tool->f_N[k] -= f[k];
        on_tool->t_Nm[k] += t[k] - (arm[next] * f[other] - arm[other] * f[next]);
    }
}

// A grain in the box about the tool.
static void meet_tool(void *const data, const dGeomID a, const dGeomID b)
{
    struct dig_ode_bed *const bed      = data;
    const size_t              i        = number_of(a == bed->tool_box ? b : a);
    const double              radius_m = bed->kind[bed->of[i]].radius_m;
    double                    body_m[3];
    dig_tool_to_body(bed->tool, dBodyGetPosition(bed->body[i]), body_m);
    struct dig_ode_touch at[DIG_PLATES_MAX];
    const size_t         touches =
        dig_ode_touch_find(bed->tool, body_m, radius_m, (uint32_t)i, &bed->memory, at);
    for (size_t k = 0; k < touches; k++) {
        push_tool(bed, i, body_m, &at[k]);
        if (!dig_ode_touch_keep(&at[k], (uint32_t)i, &bed->memory)) {
            bed->short_of_memory = true;
        }
    }
}

// The box that holds the tool, grown by nothing: grains' own boxes overlap it when they touch.
static void place_box(const struct dig_ode_bed *const bed)
{
    const struct dig_tool *const tool    = bed->tool;
    double                       low[3]  = { INFINITY, 0.0, INFINITY };
    double                       high[3] = { -INFINITY, 0.0, -INFINITY };
    for (size_t k = 0; k < tool->bucket.points; k++) {
        const double body[3] = { tool->bucket.x_m[k], 0.0, tool->bucket.z_m[k] };
        double       world[3];
        dig_tool_turn(tool, body, world);
        low[0]  = fmin(low[0], world[0]);
        low[2]  = fmin(low[2], world[2]);
        high[0] = fmax(high[0], world[0]);
        high[2] = fmax(high[2], world[2]);
    }
    dGeomBoxSetLengths(bed->tool_box, high[0] - low[0], tool->bucket.width_m, high[2] - low[2]);
    dGeomSetPosition(bed->tool_box, tool->pose.x_m + 0.5 * (low[0] + high[0]), 0.0,
                     tool->pose.z_m + 0.5 * (low[2] + high[2]));
}

enum dig_status dig_ode_bed_step(struct dig_ode_bed *const bed, const struct dig_tool *const tool,
                                 struct dig_wrench *const on_tool)
{
    bed->tool    = tool;
    bed->on_tool = (struct dig_wrench){ 0 };
    bed->share   = bed->started ? 1.0 : 0.5;
    dSpaceCollide(bed->grains_space, bed, meet_grain);
    dSpaceCollide2((dGeomID)bed->grains_space, (dGeomID)bed->walls_space, bed, meet_wall);
    if (tool != NULL) {
        place_box(bed);
        dSpaceCollide2((dGeomID)bed->grains_space, bed->tool_box, bed, meet_tool);
    }
    dig_ode_memory_turn(&bed->memory);
    if (bed->short_of_memory) {
        return DIG_ENOMEM;
    }
    const double *const g = bed->gravity_mps2;
    dWorldSetGravity(bed->world, bed->share * g[0], bed->share * g[1], bed->share * g[2]);
    if (!dWorldQuickStep(bed->world, bed->dt_s)) {
        return DIG_ENOMEM;
    }
    bed->started = true;
    *on_tool     = bed->on_tool;
    return DIG_OK;
}

struct dig_motion dig_ode_bed_motion(const struct dig_ode_bed *const bed, const size_t grain)
{
    struct dig_motion  motion = { 0 };
    const dReal *const x      = dBodyGetPosition(bed->body[grain]);
    const dReal *const v      = dBodyGetLinearVel(bed->body[grain]);
    const dReal *const w      = dBodyGetAngularVel(bed->body[grain]);
    for (int k = 0; k < 3; k++) {
        motion.x_m[k]     = x[k];
        motion.v_mps[k]   = v[k];
        motion.w_radps[k] = w[k];
    }
    return motion;
}

static void add_grain(struct dig_ode_bed *const bed, const struct dig_kind *const kind,
                      const struct dig_motion *const m, const size_t i)
{
    bed->body[i] = dBodyCreate(bed->world);
    dMass mass;
    dMassSetParameters(&mass, kind->mass_kg, 0.0, 0.0, 0.0, kind->inertia_kgm2, kind->inertia_kgm2,
                       kind->inertia_kgm2, 0.0, 0.0, 0.0);
    dBodySetMass(bed->body[i], &mass);
    dBodySetPosition(bed->body[i], m->x_m[0], m->x_m[1], m->x_m[2]);
    dBodySetLinearVel(bed->body[i], m->v_mps[0], m->v_mps[1], m->v_mps[2]);
    dBodySetAngularVel(bed->body[i], m->w_radps[0], m->w_radps[1], m->w_radps[2]);
    dBodySetGyroscopicMode(bed->body[i], 0);
    bed->ball[i] = dCreateSphere(bed->grains_space, kind->radius_m);
    dGeomSetBody(bed->ball[i], bed->body[i]);
    dGeomSetData(bed->ball[i], (void *)(uintptr_t)i); // NOLINT(performance-no-int-to-ptr)
}

// Cells as large as the smallest grain to as large as the largest: the default levels are made for
// metres, and ten times too slow here.
static void make_space(struct dig_ode_bed *const bed, const struct dig_grains *const grains)
{
    double least_m = INFINITY;
    double most_m  = 0.0;
    for (size_t k = 0; k < grains->kinds; k++) {
        least_m = fmin(least_m, 2.0 * grains->kind[k].radius_m);
        most_m  = fmax(most_m, 2.0 * grains->kind[k].radius_m);
    }
    bed->grains_space = dHashSpaceCreate(NULL);
    dHashSpaceSetLevels(bed->grains_space, (int)floor(log2(least_m)), (int)ceil(log2(most_m)));
    bed->walls_space = dSimpleSpaceCreate(NULL);
    bed->tool_box    = dCreateBox(NULL, 1.0, 1.0, 1.0);
}

struct dig_ode_bed *dig_ode_bed_create(const struct dig_world *const world)
{
    if (world->bodies != NULL) {
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
    memcpy(bed->kind, grains->kind, sizeof bed->kind);
    memcpy(bed->pair_law, world->pair_law, sizeof bed->pair_law);
    memcpy(bed->wall_law, world->wall_law, sizeof bed->wall_law);
    memcpy(bed->tool_law, world->tool_law, sizeof bed->tool_law);
    bed->body = calloc(bed->n + 1, sizeof *bed->body);
    bed->ball = calloc(bed->n + 1, sizeof *bed->ball);
    bed->of   = calloc(bed->n + 1, sizeof *bed->of);
    if (bed->body == NULL || bed->ball == NULL || bed->of == NULL) {
        dig_ode_bed_destroy(bed);
        return NULL;
    }
    memcpy(bed->of, grains->of, bed->n * sizeof *bed->of);
    for (size_t i = 0; i < bed->n; i++) {
        add_grain(bed, &grains->kind[grains->of[i]], &grains->motion[i], i);
    }
    for (size_t k = 0; k < world->walls; k++) {
        const struct dig_wall *const wall = &world->wall[k];
        const dGeomID plane = dCreatePlane(bed->walls_space, wall->normal[0], wall->normal[1],
                                           wall->normal[2], wall->offset_m);
        dGeomSetData(plane, (void *)(uintptr_t)k); // NOLINT(performance-no-int-to-ptr)
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
    dWorldDestroy(bed->world);
    dCloseODE();
    dig_ode_memory_finish(&bed->memory);
    free(bed->body);
    free(bed->ball);
    free(bed->of);
    free(bed);
}
