#include "offline_dem/reference/ode_contacts.h"

#include "offline_dem/law/law_general.h"
#include "offline_dem/reference/ode_touch.h"

// Numbers of walls and rocks in contact memory, beyond any grain's.
#define WALL_NUMBER 0xFFFF0000U
#define ROCK_NUMBER 0xFFFF4000U

static size_t number_of(dGeomID geom)
{
    return (size_t)(uintptr_t)dGeomGetData(geom);
}

static void relative(dBodyID i, dBodyID j, struct dig_touch *const t)
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
static void load_first(const struct dig_ode_bed *const bed, dBodyID i,
                       const struct dig_push *const p)
{
    const double s = bed->share;
    dBodyAddForce(i, s * p->fx_N, s * p->fy_N, s * p->fz_N);
    dBodyAddTorque(i, s * p->ix_Nm, s * p->iy_Nm, s * p->iz_Nm);
}

static void load_second(const struct dig_ode_bed *const bed, dBodyID j,
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

static bool comes_second(const struct dig_ode_bed *const bed, const size_t a, const size_t b)
{
    return bed->of[a] > bed->of[b] || (bed->of[a] == bed->of[b] && a > b);
}

// Two grains whose boxes overlap. The law's i is the one of the lower kind, as in the kernel.
void dig_ode_contacts_grain(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const bed = data;
    if (comes_second(bed, number_of(a), number_of(b))) {
        dGeomID first = b;
        b             = a;
        a             = first;
    }
    const size_t na = number_of(a);
    const size_t nb = number_of(b);
    dContactGeom contact;
    if (dCollide(a, b, 1, &contact, sizeof contact) == 0) {
        return;
    }
    const struct dig_law *const law =
        &bed->pair_law[bed->of[na] * DIG_GRAIN_TYPES_MAX + bed->of[nb]];
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

void dig_ode_contacts_wall(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const bed  = data;
    const bool                swap = dGeomGetClass(a) == dPlaneClass;
    dGeomID                   ball = swap ? b : a;
    dGeomID                   wall = swap ? a : b;
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

// What a push does to the body that gets the other end of it, about the point the arm starts from.
static void react(const struct dig_push *const p, const double arm_m[3], double f_N[3],
                  double t_Nm[3])
{
    const double f[3] = { p->fx_N, p->fy_N, p->fz_N };
    const double t[3] = { p->jx_Nm, p->jy_Nm, p->jz_Nm };
    for (int k = 0; k < 3; k++) {
        const int next  = (k + 1) % 3;
        const int other = (k + 2) % 3;
        f_N[k] -= f[k];
        t_Nm[k] += t[k] - (arm_m[next] * f[other] - arm_m[other] * f[next]);
    }
}

// A grain and a rock whose boxes overlap.
void dig_ode_contacts_rock(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const bed   = data;
    const bool                swap  = dGeomGetSpace(a) == bed->rocks_space;
    dGeomID                   ball  = swap ? b : a;
    dGeomID                   stone = swap ? a : b;
    dContactGeom              contact;
    if (dCollide(ball, stone, 1, &contact, sizeof contact) == 0) {
        return;
    }
    const size_t                i    = number_of(ball);
    struct dig_rock *const      rock = &bed->rock[number_of(stone)];
    const struct dig_law *const law  = &bed->wall_law[bed->of[i]];
    struct dig_memory *const    memory =
        dig_ode_memory_of(&bed->memory, (uint32_t)i, ROCK_NUMBER + (uint32_t)number_of(stone));
    if (memory == NULL) {
        bed->short_of_memory = true;
        return;
    }
    struct dig_touch touch = { 0 };
    set_distance(&touch, &contact, law->reach_m);
    relative(bed->body[i], NULL, &touch);
    const dReal *const  x        = dBodyGetPosition(bed->body[i]);
    const double *const w        = rock->body.w_radps;
    const double *const v        = rock->body.v_mps;
    const double        arm_m[3] = { x[0] - touch.dx_m - rock->body.x_m[0],
                                     x[1] - touch.dy_m - rock->body.x_m[1],
                                     x[2] - touch.dz_m - rock->body.x_m[2] };
    touch.vx_mps -= v[0] + w[1] * arm_m[2] - w[2] * arm_m[1];
    touch.vy_mps -= v[1] + w[2] * arm_m[0] - w[0] * arm_m[2];
    touch.vz_mps -= v[2] + w[0] * arm_m[1] - w[1] * arm_m[0];
    touch.jx_radps             = w[0];
    touch.jy_radps             = w[1];
    touch.jz_radps             = w[2];
    const struct dig_push push = law_of(law, bed->dt_s, touch, memory);
    load_first(bed, bed->body[i], &push);
    react(&push, arm_m, rock->f_N, rock->t_Nm);
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
    react(&p, arm, bed->on_tool.f_N, bed->on_tool.t_Nm);
}

// A grain in the box about the tool.
void dig_ode_contacts_tool(void *const data, dGeomID a, dGeomID b)
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
