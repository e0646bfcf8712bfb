#include "offline_dem/world/ode_rocks.h"

#include "offline_dem/shapes/bucket_surface.h"
#include "offline_dem/world/ode_scene_private.h"

#include <math.h>
#include <string.h>

#define CONTACTS_MAX 8 // of one pair of geometries

// One step: its contacts, and their reaction on the bucket.
struct rock_step {
    struct dig_ode_scene *ode;
    const struct dig_law *law;
    double                dt_s;
    size_t                joints;
    dJointFeedback        feedback[DIG_OBSTACLES_MAX * CONTACTS_MAX];
};

static void remove_all(struct dig_ode_scene *const ode)
{
    for (size_t i = 0; i < ode->count; i++) {
        dGeomDestroy(ode->rock[i]);
        if (ode->body[i] != NULL) {
            dBodyDestroy(ode->body[i]);
        }
    }
    ode->count = 0;
}

static dBodyID make_body(struct dig_ode_scene *const ode, const struct dig_rock *const rock)
{
    dBodyID             body = dBodyCreate(ode->world);
    const double *const h    = rock->surface.half_m;
    dMass               mass;
    if (rock->surface.shape == DIG_OBSTACLE_BOX) {
        dMassSetBoxTotal(&mass, rock->mass_kg, 2.0 * h[0], 2.0 * h[1], 2.0 * h[2]);
    } else {
        dMassSetSphereTotal(&mass, rock->mass_kg, h[0]);
    }
    dBodySetMass(body, &mass);
    dBodySetPosition(body, rock->surface.x_m[0], rock->surface.x_m[1], rock->surface.x_m[2]);
    dBodySetQuaternion(body, rock->surface.q);
    dBodySetLinearVel(body, rock->v_mps[0], rock->v_mps[1], rock->v_mps[2]);
    dBodySetAngularVel(body, rock->w_radps[0], rock->w_radps[1], rock->w_radps[2]);
    dBodySetAutoDisableFlag(body, 0);
    return body;
}

dGeomID dig_ode_rocks_shape(dSpaceID space, const struct dig_rock_surface *const rock)
{
    const double *const h = rock->half_m;
    return rock->shape == DIG_OBSTACLE_BOX ? dCreateBox(space, 2.0 * h[0], 2.0 * h[1], 2.0 * h[2])
                                           : dCreateSphere(space, h[0]);
}

void dig_ode_rocks_set(struct dig_ode_scene *const ode, const size_t rocks,
                       const struct dig_rock rock[])
{
    remove_all(ode);
    for (size_t i = 0; i < rocks; i++) {
        ode->rock[i] = dig_ode_rocks_shape(ode->rocks, &rock[i].surface);
        // Points to the rock's entry, from which a contact finds its number.
        dGeomSetData(ode->rock[i], &ode->rock[i]);
        ode->body[i] = rock[i].movable ? make_body(ode, &rock[i]) : NULL;
        if (ode->body[i] != NULL) {
            dGeomSetBody(ode->rock[i], ode->body[i]);
        } else {
            const double *const x = rock[i].surface.x_m;
            dGeomSetPosition(ode->rock[i], x[0], x[1], x[2]);
            dGeomSetQuaternion(ode->rock[i], rock[i].surface.q);
        }
    }
    ode->count = rocks;
}

static size_t rock_of(const struct dig_ode_scene *const ode, dGeomID geom)
{
    return (size_t)((const dGeomID *)dGeomGetData(geom) - ode->rock);
}

// A contact joint as soft as the law's spring and damper over one step.
static dJointID add_joint(struct rock_step *const m, const dContactGeom *const at,
                          const size_t rock, dBodyID a, dBodyID b)
{
    const struct dig_law *const t        = &m->law[rock];
    const double                softness = m->dt_s * t->normal_Npm + t->damping_Nspm;
    dContact                    contact  = { .geom = *at };
    contact.surface.mode                 = dContactSoftERP | dContactSoftCFM | dContactApprox1;
    contact.surface.mu                   = t->friction;
    contact.surface.soft_erp             = m->dt_s * t->normal_Npm / softness;
    contact.surface.soft_cfm             = 1.0 / softness;
    dJointID joint = dJointCreateContact(m->ode->world, m->ode->contact_joints, &contact);
    dJointAttach(joint, a, b);
    return joint;
}

static void collide(void *const data, dGeomID a, dGeomID b)
{
    struct rock_step *const m       = data;
    const bool              swapped = dGeomGetData(a) == NULL;
    dGeomID                 rock    = swapped ? b : a;
    dGeomID                 other   = swapped ? a : b;
    dContactGeom            found[CONTACTS_MAX];
    if (dGeomGetBody(rock) == NULL && dGeomGetBody(other) == NULL) {
        return;
    }
    const int count = dCollide(rock, other, CONTACTS_MAX, found, sizeof found[0]);
    for (int c = 0; c < count; c++) {
        (void)add_joint(m, &found[c], rock_of(m->ode, rock), dGeomGetBody(rock),
                        dGeomGetBody(other));
    }
}

static void add_bucket_joint(struct rock_step *const m, const dContactGeom *const at,
                             const size_t rock)
{
    if (m->joints < sizeof m->feedback / sizeof m->feedback[0]) {
        dJointID joint = add_joint(m, at, rock, m->ode->body[rock], m->ode->bucket);
        dJointSetFeedback(joint, &m->feedback[m->joints++]);
    }
}

// Contact of a sphere with the plates, as of a grain: at the closest point of the tool.
static void collide_plates(struct rock_step *const m, const struct dig_tool *const tool,
                           const struct dig_rock *const rock, const size_t number)
{
    double body_m[3];
    double least_m    = INFINITY;
    double closest[3] = { 0.0, 0.0, 0.0 };
    dig_tool_to_body(tool, rock->surface.x_m, body_m);
    for (size_t p = 0; p < tool->plates; p++) {
        double c[3];
        dig_bucket_closest(&tool->bucket, p, body_m, c);
        const double d_m = hypot(hypot(body_m[0] - c[0], body_m[1] - c[1]), body_m[2] - c[2]);
        if (d_m < least_m) {
            least_m = d_m;
            memcpy(closest, c, sizeof closest);
        }
    }
    if (!(least_m < rock->surface.half_m[0]) || !(least_m > 0.0)) {
        return;
    }
    double d_m[3];
    double arm_m[3];
    double v_mps[3];
    dig_tool_separation(tool, body_m, closest, d_m, arm_m, v_mps);
    dContactGeom at = { .depth = rock->surface.half_m[0] - least_m };
    for (int k = 0; k < 3; k++) {
        at.normal[k] = d_m[k] / least_m;
        at.pos[k]    = arm_m[k];
    }
    at.pos[0] += tool->pose.x_m;
    at.pos[2] += tool->pose.z_m;
    add_bucket_joint(m, &at, number);
}

// Contacts of a box with the triangles of the bucket.
static void collide_bucket(struct rock_step *const m, const size_t rock)
{
    dContactGeom found[CONTACTS_MAX];
    const int    count =
        dCollide(m->ode->rock[rock], m->ode->shell, CONTACTS_MAX, found, sizeof found[0]);
    for (int c = 0; c < count; c++) {
        add_bucket_joint(m, &found[c], rock);
    }
}

static void read_back(const struct dig_ode_scene *const ode, struct dig_rock rock[])
{
    for (size_t i = 0; i < ode->count; i++) {
        if (ode->body[i] == NULL) {
            continue;
        }
        memcpy(rock[i].surface.x_m, dBodyGetPosition(ode->body[i]), sizeof rock[i].surface.x_m);
        memcpy(rock[i].v_mps, dBodyGetLinearVel(ode->body[i]), sizeof rock[i].v_mps);
        memcpy(rock[i].w_radps, dBodyGetAngularVel(ode->body[i]), sizeof rock[i].w_radps);
        memcpy(rock[i].surface.q, dBodyGetQuaternion(ode->body[i]), sizeof rock[i].surface.q);
    }
}

void dig_ode_rocks_step(struct dig_ode_scene *const ode, const struct dig_tool *const tool,
                        const struct dig_law law[], const double dt_s, struct dig_rock rock[],
                        struct dig_wrench *const on_tool)
{
    struct rock_step m = { .ode = ode, .law = law, .dt_s = dt_s };
    dSpaceCollide(ode->rocks, &m, collide);
    dSpaceCollide2((dGeomID)ode->rocks, (dGeomID)ode->walls, &m, collide);
    for (size_t i = 0; i < ode->count; i++) {
        if (ode->body[i] == NULL) {
            continue;
        }
        if (tool != NULL && rock[i].surface.shape == DIG_OBSTACLE_SPHERE) {
            collide_plates(&m, tool, &rock[i], i);
        } else if (tool != NULL) {
            collide_bucket(&m, i);
        }
        dBodyAddForce(ode->body[i], rock[i].load.f_N[0], rock[i].load.f_N[1], rock[i].load.f_N[2]);
        dBodyAddTorque(ode->body[i], rock[i].load.t_Nm[0], rock[i].load.t_Nm[1],
                       rock[i].load.t_Nm[2]);
    }
    dWorldStep(ode->world, dt_s);
    for (size_t i = 0; i < m.joints; i++) {
        for (int k = 0; k < 3; k++) {
            on_tool->f_N[k] += m.feedback[i].f2[k];
            on_tool->t_Nm[k] += m.feedback[i].t2[k];
        }
    }
    dJointGroupEmpty(ode->contact_joints);
    read_back(ode, rock);
}
