#include "offline_dem/reference/ode_contacts.h"

#include "offline_dem/law/law_general.h"
#include "offline_dem/shapes/plate_contacts.h"

// Numbers of walls, rocks and plates in the contact history, beyond any grain's.
#define WALL_NUMBER  0xFFFF0000U
#define ROCK_NUMBER  0xFFFF4000U
#define PLATE_NUMBER 0xFFFF8000U

static size_t index_of(dGeomID geom)
{
    return (size_t)(uintptr_t)dGeomGetData(geom);
}

struct dig_motion dig_ode_contacts_motion(dBodyID body)
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

// Loads on i, scaled by the fraction of a kick.
static void add_load_to_i(const struct dig_ode_bed *const bed, dBodyID i,
                          const struct dig_contact_force *const p)
{
    const double s = bed->kick_fraction;
    dBodyAddForce(i, s * p->fx_N, s * p->fy_N, s * p->fz_N);
    dBodyAddTorque(i, s * p->ix_Nm, s * p->iy_Nm, s * p->iz_Nm);
}

static void add_load_to_j(const struct dig_ode_bed *const bed, dBodyID j,
                          const struct dig_contact_force *const p)
{
    const double s = bed->kick_fraction;
    dBodyAddForce(j, -s * p->fx_N, -s * p->fy_N, -s * p->fz_N);
    dBodyAddTorque(j, s * p->jx_Nm, s * p->jy_Nm, s * p->jz_Nm);
}

// Of two bodies at one place; NULL: one at rest.
static struct dig_kinematics velocities(dBodyID i, dBodyID j)
{
    const struct dig_motion a = dig_ode_contacts_motion(i);
    const struct dig_motion b = j != NULL ? dig_ode_contacts_motion(j) : (struct dig_motion){ 0 };
    return dig_motion_between(&a, &b);
}

static void set_distance(struct dig_kinematics *const t, const dContactGeom *const c,
                         const double reach_m)
{
    const double d_m = reach_m - c->depth;
    t->dx_m          = d_m * c->normal[0];
    t->dy_m          = d_m * c->normal[1];
    t->dz_m          = d_m * c->normal[2];
}

// The contact of grain a with b, whose body is j (NULL: it does not move as ODE's body) and whose
// number in the history is other. NULL: there is none, or memory is short.
static struct dig_contact_history *begin_contact(struct dig_ode_bed *const bed, dGeomID a,
                                                 dGeomID b, dBodyID j, const uint32_t other,
                                                 const struct dig_law *const  law,
                                                 struct dig_kinematics *const kinematics)
{
    dContactGeom contact;
    if (dCollide(a, b, 1, &contact, sizeof contact) == 0) {
        return NULL;
    }
    const size_t                      i = index_of(a);
    struct dig_contact_history *const history =
        dig_ode_history_of(&bed->history, (uint32_t)i, other);
    bed->out_of_memory = bed->out_of_memory || history == NULL;
    *kinematics        = velocities(bed->body[i], j);
    set_distance(kinematics, &contact, law->reach_m);
    return history;
}

static bool comes_second(const struct dig_ode_bed *const bed, const size_t a, const size_t b)
{
    return bed->type_of[a] > bed->type_of[b] || (bed->type_of[a] == bed->type_of[b] && a > b);
}

// Two grains whose boxes overlap. The law's i is the one of the lower type, as in the kernel.
void dig_ode_contacts_grain(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const bed = data;
    if (comes_second(bed, index_of(a), index_of(b))) {
        dGeomID first = b;
        b             = a;
        a             = first;
    }
    const size_t                na = index_of(a);
    const size_t                nb = index_of(b);
    const struct dig_law *const law =
        &bed->pair_law[bed->type_of[na] * DIG_GRAIN_TYPES_MAX + bed->type_of[nb]];
    struct dig_kinematics             kinematics;
    struct dig_contact_history *const history =
        begin_contact(bed, a, b, bed->body[nb], (uint32_t)nb, law, &kinematics);
    if (history == NULL) {
        return;
    }
    const struct dig_contact_force force = dig_law_apply(law, bed->dt_s, &kinematics, history);
    add_load_to_i(bed, bed->body[na], &force);
    add_load_to_j(bed, bed->body[nb], &force);
}

void dig_ode_contacts_wall(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const         bed        = data;
    const bool                        swap       = dGeomGetClass(a) == dPlaneClass;
    dGeomID                           grain_geom = swap ? b : a;
    dGeomID                           wall       = swap ? a : b;
    const size_t                      i          = index_of(grain_geom);
    const struct dig_law *const       law        = &bed->wall_law[bed->type_of[i]];
    struct dig_kinematics             kinematics;
    struct dig_contact_history *const history = begin_contact(
        bed, grain_geom, wall, NULL, WALL_NUMBER + (uint32_t)index_of(wall), law, &kinematics);
    if (history == NULL) {
        return;
    }
    const struct dig_contact_force force = dig_law_apply(law, bed->dt_s, &kinematics, history);
    add_load_to_i(bed, bed->body[i], &force);
}

static void add_reaction(const struct dig_contact_force *const p, const double arm_m[3],
                         struct dig_wrench *const sum)
{
    const double f[3] = { p->fx_N, p->fy_N, p->fz_N };
    const double t[3] = { p->jx_Nm, p->jy_Nm, p->jz_Nm };
    dig_wrench_react(f, t, arm_m, sum);
}

// A grain and a rock whose boxes overlap.
void dig_ode_contacts_rock(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const         bed        = data;
    const bool                        swap       = dGeomGetSpace(a) == bed->rocks_space;
    dGeomID                           grain_geom = swap ? b : a;
    dGeomID                           rock_geom  = swap ? a : b;
    const size_t                      i          = index_of(grain_geom);
    struct dig_rock *const            rock       = &bed->rock[index_of(rock_geom)];
    const struct dig_law *const       law        = &bed->wall_law[bed->type_of[i]];
    struct dig_kinematics             kinematics;
    struct dig_contact_history *const history =
        begin_contact(bed, grain_geom, rock_geom, NULL, ROCK_NUMBER + (uint32_t)index_of(rock_geom),
                      law, &kinematics);
    if (history == NULL) {
        return;
    }
    const dReal *const  x        = dBodyGetPosition(bed->body[i]);
    const double *const w        = rock->w_radps;
    const double *const v        = rock->v_mps;
    const double        arm_m[3] = { x[0] - kinematics.dx_m - rock->surface.x_m[0],
                                     x[1] - kinematics.dy_m - rock->surface.x_m[1],
                                     x[2] - kinematics.dz_m - rock->surface.x_m[2] };
    kinematics.vx_mps -= v[0] + w[1] * arm_m[2] - w[2] * arm_m[1];
    kinematics.vy_mps -= v[1] + w[2] * arm_m[0] - w[0] * arm_m[2];
    kinematics.vz_mps -= v[2] + w[0] * arm_m[1] - w[1] * arm_m[0];
    kinematics.jx_radps                  = w[0];
    kinematics.jy_radps                  = w[1];
    kinematics.jz_radps                  = w[2];
    const struct dig_contact_force force = dig_law_apply(law, bed->dt_s, &kinematics, history);
    add_load_to_i(bed, bed->body[i], &force);
    add_reaction(&force, arm_m, &rock->load);
}

// One contact of a grain with the tool, at a given point with its history.
static void add_plate_load(struct dig_ode_bed *const bed, const size_t i, const double body_m[3],
                           const double closest_m[3], struct dig_contact_history *const history)
{
    double d[3];
    double arm_m[3];
    double v_mps[3];
    dig_tool_separation(bed->tool, body_m, closest_m, d, arm_m, v_mps);
    struct dig_kinematics kinematics = velocities(bed->body[i], NULL);
    kinematics.dx_m                  = d[0];
    kinematics.dy_m                  = d[1];
    kinematics.dz_m                  = d[2];
    kinematics.vx_mps -= v_mps[0];
    kinematics.vz_mps -= v_mps[2];
    const struct dig_contact_force p =
        dig_law_apply(&bed->tool_law[bed->type_of[i]], bed->dt_s, &kinematics, history);
    add_load_to_i(bed, bed->body[i], &p);
    add_reaction(&p, arm_m, &bed->on_tool);
}

// A grain in the box about the tool.
void dig_ode_contacts_tool(void *const data, dGeomID a, dGeomID b)
{
    struct dig_ode_bed *const    bed      = data;
    const struct dig_tool *const tool     = bed->tool;
    const size_t                 i        = index_of(a == bed->tool_box ? b : a);
    const double                 radius_m = bed->type[bed->type_of[i]].radius_m;
    double                       body_m[3];
    struct dig_plate_contacts    near;
    near.count = 0;
    dig_tool_to_body(tool, dBodyGetPosition(bed->body[i]), body_m);
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
        add_plate_load(bed, i, body_m, near.closest_m[k], &near.history[k]);
        struct dig_contact_history *const kept =
            dig_ode_history_of(&bed->history, (uint32_t)i, PLATE_NUMBER + (uint32_t)near.plate[k]);
        bed->out_of_memory = bed->out_of_memory || kept == NULL;
        if (kept != NULL) {
            *kept = near.history[k];
        }
    }
}
