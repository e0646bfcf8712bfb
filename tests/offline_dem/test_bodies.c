// Tests for offline_dem/world/bodies.c and obstacles.c: clumps and rocks in a world of grains,
// against conservation laws and against a rigid body of the Open Dynamics Engine.

#include "tests/dem_fixture.h"

#include "offline_dem/dig/dig.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <ode/ode.h>

static const struct dig_gravel gravel = { { 0.4, 0.2, DENSITY } };

static struct dig_scene clump_scene(const double dt_s)
{
    return (struct dig_scene){
        .name         = "clumps",
        .bucket       = { .points  = 3,
                          .x_m     = { 0.0, -0.01, 0.0 },
                          .z_m     = { -0.03, -0.02, 0.0 },
                          .width_m = 0.02 },
        .box          = { -1.0, 1.0, -1.0, 1.0, 0.0, 1.0 },
        .packing      = { 0.3, 0.6, 0.3, 0.3, 0.1 },
        .material     = { 2.0 * GRAIN_m, 5e6, 0.2, 0.2, 2.0 },
        .gravity_mps2 = GRAVITY,
        .time_step_s  = dt_s,
        .output_s     = 0.005,
        .bed.clump    = { .spheres = 3,
                          .x       = { -0.8, 0.8, 0.1 },
                          .z       = { 0.0, 0.1, 0.7 },
                          .y       = { 0.0, 0.2, -0.1 },
                          .radius  = { 1.0, 0.8, 0.7 } },
        .trajectories = 1,
        .trajectory   = { { .name = "none", .phases = 1, .phase = { { "none", 1.0, 0, 0, 0 } } } },
    };
}

// Clumps with their centres at these places, turned by these rotation vectors.
static struct dig_world make_world(const struct dig_scene *const scene, const size_t clumps,
                                   const double at_m[][3], const double turned[][3])
{
    struct dig_clump_shape shape;
    struct dig_bed         bed;
    assert_int_equal(dig_clump_shape_make(&scene->bed.clump, &shape), DIG_OK);
    const size_t n = shape.spheres > 0 ? shape.spheres : 1;
    assert_int_equal(dig_bed_create(clumps * n, false, shape.spheres > 0, &bed), DIG_OK);
    for (size_t b = 0; b < clumps; b++) {
        double q[4] = { 1.0, 0.0, 0.0, 0.0 };
        dig_rigid_integrate(q, turned[b], 1.0, q);
        for (size_t k = 0; k < n; k++) {
            double arm[3] = { 0.0, 0.0, 0.0 };
            if (shape.spheres > 0) {
                dig_rigid_rotate(q, shape.at[k], arm);
                bed.clump[b * n + k] = (uint32_t)(b + 1);
            }
            bed.x_m[b * n + k]      = at_m[b][0] + 2.0 * GRAIN_m * arm[0];
            bed.y_m[b * n + k]      = at_m[b][1] + 2.0 * GRAIN_m * arm[1];
            bed.z_m[b * n + k]      = at_m[b][2] + 2.0 * GRAIN_m * arm[2];
            bed.radius_m[b * n + k] = 2.0 * GRAIN_m * (shape.spheres > 0 ? shape.radius[k] : 0.5);
        }
    }
    struct dig_world world;
    struct dig_error error = { "" };
    assert_ok(dig_setup_world(scene, &gravel, &bed, 0.0, NULL, &world, &error), error);
    dig_bed_finish(&bed);
    world.single = false; // motions are read, and compared more finely
    return world;
}

TEST(a_clump_weighs_what_its_volume_weighs_and_falls_like_it)
{
    struct dig_scene                   scene    = clump_scene(1e-5);
    const double                       at[1][3] = { { 0.0, 0.0, 0.5 } };
    const double                       no[1][3] = { { 0.3, -1.0, 0.5 } };
    struct dig_world                   world    = make_world(&scene, 1, at, no);
    const struct dig_clump_body *const c        = &world.bodies->clump[0];
    assert_close(c->body.mass_kg, GRAIN_kg, 1e-12);
    double shares_kg = 0.0;
    for (size_t i = 0; i < 3; i++) {
        shares_kg += world.grains.type[world.grains.type_of[i]].mass_kg;
    }
    assert_close(shares_kg, GRAIN_kg, 1e-12);
    dem_run(&world, 10000);
    assert_close(c->body.x_m[2], 0.5 - 0.5 * GRAVITY * 0.01, 1e-12);
    // The spheres are where the body has them.
    for (size_t k = 0; k < 3; k++) {
        double arm[3];
        dig_rigid_rotate(c->body.q, world.bodies->shape.at[k], arm);
        for (int a = 0; a < 3; a++) {
            assert_close(world.grains.motion[c->member[k]].x_m[a],
                         c->body.x_m[a] + c->unit_m * arm[a], 1e-13);
        }
    }
    dig_setup_finish(&world);
}

static void sum_up(const struct dig_world *const world, double p_Ns[3], double l_Nms[3])
{
    for (int a = 0; a < 3; a++) {
        p_Ns[a]  = 0.0;
        l_Nms[a] = 0.0;
    }
    for (size_t b = 0; b < world->bodies->clumps; b++) {
        const struct dig_rigid *const body = &world->bodies->clump[b].body;
        for (int a = 0; a < 3; a++) {
            const int    y = (a + 1) % 3;
            const int    z = (a + 2) % 3;
            const double m = body->mass_kg;
            p_Ns[a] += m * body->v_mps[a];
            l_Nms[a] += body->l_Nms[a] +
                        m * (body->x_m[y] * body->v_mps[z] - body->x_m[z] * body->v_mps[y]);
        }
    }
}

// Two that meet off centre: what one gains the other loses. Angular momentum is taken with
// velocities half a step behind positions, and the law puts a pair's forces on one line.
TEST(clumps_that_collide_conserve_momentum)
{
    struct dig_scene scene               = clump_scene(1e-6);
    scene.gravity_mps2                   = 1e-300;
    const double     at[2][3]            = { { -0.006, 0.001, 0.5 }, { 0.007, 0.0, 0.502 } };
    const double     by[2][3]            = { { 0.3, -1.0, 0.5 }, { 1.0, 0.2, 2.0 } };
    struct dig_world world               = make_world(&scene, 2, at, by);
    world.bodies->clump[0].body.v_mps[0] = 0.8;
    world.bodies->clump[1].body.v_mps[0] = -0.4;
    double p[2][3], l[2][3];
    sum_up(&world, p[0], l[0]);
    double turning = 0.0;
    for (int s = 0; s < 20000; s++) {
        dem_run(&world, 1);
        turning = fmax(turning, fabs(world.bodies->clump[0].body.w_radps[1]));
    }
    sum_up(&world, p[1], l[1]);
    assert_true(turning > 10.0);
    assert_true(world.bodies->clump[1].body.v_mps[0] > 0.0);
    const double scale = GRAIN_kg * 0.8;
    for (int a = 0; a < 3; a++) {
        assert_close(p[1][a], p[0][a], 1e-12 * scale);
        assert_close(l[1][a], l[0][a], 1e-6 * scale * GRAIN_m);
    }
    dig_setup_finish(&world);
}

// The same clump as a body of the Open Dynamics Engine, pushed by the law of its spheres with the
// floor, at a step so small that the engine's first order does not matter.
struct other {
    dWorldID                   world;
    dBodyID                    body;
    struct dig_clump_shape     shape;
    struct dig_law             law[3];
    struct dig_contact_history history[3];
};

static void push_other(struct other *const o, const double dt_s)
{
    for (size_t k = 0; k < 3; k++) {
        const double *const at = o->shape.at[k];
        const double        d  = 2.0 * GRAIN_m;
        dVector3            x, v;
        dBodyGetRelPointPos(o->body, d * at[0], d * at[1], d * at[2], x);
        dBodyGetRelPointVel(o->body, d * at[0], d * at[1], d * at[2], v);
        const dReal *const             w     = dBodyGetAngularVel(o->body);
        const struct dig_kinematics    touch = { 0.0,  0.0,  x[2], v[0], v[1], v[2],
                                                 w[0], w[1], w[2], 0.0,  0.0,  0.0 };
        const struct dig_contact_force push  = dig_law_step(o->law[k], dt_s, touch, &o->history[k]);
        dBodyAddForceAtPos(o->body, push.fx_N, push.fy_N, push.fz_N, x[0], x[1], x[2]);
        dBodyAddTorque(o->body, push.ix_Nm, push.iy_Nm, push.iz_Nm);
    }
}

static struct other make_other(const struct dig_world *const ours)
{
    struct other o = { .shape = ours->bodies->shape };
    assert_true(dInitODE2(0));
    o.world = dWorldCreate();
    dWorldSetGravity(o.world, 0.0, 0.0, -GRAVITY);
    o.body = dBodyCreate(o.world);
    dMass        mass;
    const double s                  = GRAIN_kg * 4.0 * GRAIN_m * GRAIN_m;
    const double(*const inertia)[3] = (const double(*)[3])o.shape.inertia;
    dMassSetParameters(&mass, GRAIN_kg, 0.0, 0.0, 0.0, s * inertia[0][0], s * inertia[1][1],
                       s * inertia[2][2], s * inertia[0][1], s * inertia[0][2], s * inertia[1][2]);
    dBodySetMass(o.body, &mass);
    const struct dig_rigid *const body = &ours->bodies->clump[0].body;
    dBodySetPosition(o.body, body->x_m[0], body->x_m[1], body->x_m[2]);
    dBodySetQuaternion(o.body, body->q);
    for (size_t k = 0; k < 3; k++) {
        o.law[k] = ours->wall_law[ours->grains.type_of[k]];
    }
    return o;
}

TEST(a_clump_bounces_as_a_body_of_ode_does)
{
    struct dig_scene        scene    = clump_scene(1e-6);
    const double            at[1][3] = { { 0.0, 0.0, 0.010 } };
    const double            by[1][3] = { { 0.4, 0.7, 0.2 } };
    struct dig_world        world    = make_world(&scene, 1, at, by);
    const double            dt_s     = 1e-7;
    struct other            other    = make_other(&world);
    struct dig_rigid *const c        = &world.bodies->clump[0].body;
    c->v_mps[0]                      = 0.3;
    c->v_mps[2]                      = -0.8;
    dBodySetLinearVel(other.body, 0.3, 0.0, -0.8);
    const int steps = 10000; // 10 ms: into the floor and off it, turning
    double    most  = 0.0;
    dem_run(&world, (size_t)steps);
    for (int s = 0; s < steps * 10; s++) {
        push_other(&other, dt_s);
        dWorldStep(other.world, dt_s);
        most = fmax(most, dBodyGetLinearVel(other.body)[2]);
    }
    assert_true(most > 0.05);
    const dReal *const v = dBodyGetLinearVel(other.body);
    const dReal *const w = dBodyGetAngularVel(other.body);
    const dReal *const x = dBodyGetPosition(other.body);
    for (int a = 0; a < 3; a++) {
        assert_close(c->v_mps[a], v[a], 2e-3);
        assert_close(c->x_m[a], x[a], 1e-5);
        assert_close(c->w_radps[a], w[a], 0.5);
    }
    assert_true(fabs(w[0]) + fabs(w[1]) > 30.0);
    dBodyDestroy(other.body);
    dWorldDestroy(other.world);
    dCloseODE();
    dig_setup_finish(&world);
}

TEST(a_grain_rests_on_a_rock_and_the_rock_bears_it)
{
    static const enum dig_obstacle_shape shape[] = { DIG_OBSTACLE_SPHERE, DIG_OBSTACLE_BOX };
    for (size_t i = 0; i < 2; i++) {
        struct dig_scene scene    = clump_scene(5e-5);
        scene.bed.clump.spheres   = 0;
        scene.bed.obstacles       = 1;
        scene.bed.obstacle[0]     = (struct dig_obstacle){ .shape    = shape[i],
                                                           .centre_m = { 0.0, 0.0, 0.3 },
                                                           .size_m   = { 0.04, 0.04, 0.04 } };
        const double     at[1][3] = { { 0.0, 0.0, 0.3205 + GRAIN_m } };
        const double     no[1][3] = { { 0.0 } };
        struct dig_world world    = make_world(&scene, 1, at, no);
        dem_run(&world, 20000);
        const struct dig_rock *const rock = &world.bodies->obstacles.rock[0];
        assert_close(rock->load.f_N[2], -GRAIN_kg * GRAVITY, 1e-9);
        assert_close(world.grains.motion[0].x_m[2], 0.32 + GRAIN_m, 0.01 * GRAIN_m);
        assert_true(world.grains.motion[0].x_m[2] < 0.32 + GRAIN_m);
        dig_setup_finish(&world);
    }
}

// The closest point by trying many.
TEST(the_closest_point_of_a_rock_is_the_closest)
{
    struct dig_scene scene    = clump_scene(1e-5);
    scene.bed.obstacles       = 1;
    scene.bed.obstacle[0]     = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_BOX,
                                                       .centre_m = { 0.1, 0.2, 0.3 },
                                                       .size_m   = { 0.2, 0.4, 0.6 } };
    struct dig_obstacles o    = dig_obstacles_make(&scene);
    const double         w[3] = { 0.5, -0.3, 0.9 };
    dig_rigid_integrate(o.rock[0].surface.q, w, 1.0, o.rock[0].surface.q);
    const double p[3][3] = { { 0.5, 0.2, 0.9 }, { 0.1, 0.45, 0.3 }, { 0.12, 0.25, 0.3 } };
    for (size_t i = 0; i < 3; i++) {
        double       closest[3];
        const double apart = dig_rock_surface_closest(&o.rock[0].surface, p[i], closest);
        double       least = INFINITY;
        for (int face = 0; face < 6; face++) {
            for (int u = 0; u <= 100; u++) {
                for (int v = 0; v <= 100; v++) {
                    const double half[3] = { 0.1, 0.2, 0.3 };
                    double       b[3], x[3];
                    b[face / 2]           = face % 2 ? half[face / 2] : -half[face / 2];
                    b[(face / 2 + 1) % 3] = (u / 50.0 - 1.0) * half[(face / 2 + 1) % 3];
                    b[(face / 2 + 2) % 3] = (v / 50.0 - 1.0) * half[(face / 2 + 2) % 3];
                    dig_rigid_rotate(o.rock[0].surface.q, b, x);
                    least = fmin(least, hypot(hypot(x[0] + 0.1 - p[i][0], x[1] + 0.2 - p[i][1]),
                                              x[2] + 0.3 - p[i][2]));
                }
            }
        }
        assert_close(fabs(apart), least, 3e-3);
        assert_true((apart < 0.0) == (i == 2));
        assert_close(hypot(hypot(closest[0] - p[i][0], closest[1] - p[i][1]), closest[2] - p[i][2]),
                     fabs(apart), 1e-12);
    }
}

// A rock as heavy as some grains among them, nothing else in the world: what it gains they lose.
TEST(a_rock_takes_what_momentum_the_grains_lose)
{
    struct dig_scene scene            = clump_scene(5e-6);
    scene.gravity_mps2                = 1e-300;
    scene.bed.clump.spheres           = 0;
    scene.bed.obstacles               = 1;
    scene.bed.obstacle[0]             = (struct dig_obstacle){ .shape         = DIG_OBSTACLE_BOX,
                                                               .centre_m      = { 0.0, 0.0, 0.5 },
                                                               .size_m        = { 0.02, 0.016, 0.012 },
                                                               .movable       = true,
                                                               .density_kgpm3 = 2600.0 };
    const double     at[2][3]         = { { -0.02, 0.003, 0.502 }, { 0.006, 0.002, 0.52 } };
    const double     no[2][3]         = { { 0.0 } };
    struct dig_world world            = make_world(&scene, 2, at, no);
    world.grains.motion[0].v_mps[0]   = 1.0;
    world.grains.motion[1].v_mps[2]   = -0.7;
    const struct dig_rock *const rock = &world.bodies->obstacles.rock[0];
    dem_run(&world, 6000);
    assert_true(rock->v_mps[0] > 0.01 && rock->v_mps[2] < -0.01);
    assert_true(fabs(rock->w_radps[1]) > 0.1);
    const double start[3] = { GRAIN_kg, 0.0, -0.7 * GRAIN_kg };
    for (int a = 0; a < 3; a++) {
        double p_Ns = rock->mass_kg * rock->v_mps[a];
        for (size_t i = 0; i < 2; i++) {
            p_Ns += GRAIN_kg * world.grains.motion[i].v_mps[a];
        }
        assert_close(p_Ns, start[a], 1e-9 * GRAIN_kg);
    }
    dig_setup_finish(&world);
}

// The tool drives a rock ahead of it through empty space: what the rock gains the tool has felt.
// Contacts are picked long before: a grain that lies still leaves no margin, the rock does.
TEST(a_rock_that_comes_is_felt_in_the_step_it_arrives)
{
    static const enum dig_obstacle_shape shape[] = { DIG_OBSTACLE_SPHERE, DIG_OBSTACLE_BOX };
    for (size_t i = 0; i < 2; i++) {
        struct dig_scene scene  = clump_scene(2e-5);
        scene.gravity_mps2      = 1e-300;
        scene.bed.clump.spheres = 0;
        scene.bed.obstacles     = 1;
        scene.bed.obstacle[0]   = (struct dig_obstacle){ .shape         = shape[i],
                                                         .centre_m      = { 0.0, 0.0, 0.5 },
                                                         .size_m        = { 0.02, 0.06, 0.02 },
                                                         .movable       = true,
                                                         .density_kgpm3 = 2600.0 };
        // The ball flies at the grain, the box turns a face on it.
        const double     at[1][3] = { { 0.0, i == 0 ? 0.0 : 0.025, i == 0 ? 0.516 : 0.5152 } };
        const double     no[1][3] = { { 0.0 } };
        struct dig_world world    = make_world(&scene, 1, at, no);
        struct dig_rock *rock     = &world.bodies->obstacles.rock[0];
        rock->v_mps[2]            = i == 0 ? 0.4 : 0.0;
        rock->w_radps[0]          = i == 0 ? 0.0 : 20.0;
        dig_ode_rocks_set(world.bodies->ode, 1, rock);
        double apart_m = INFINITY;
        for (int s = 0; s < 2000 && apart_m >= GRAIN_m; s++) {
            double closest_m[3];
            dem_run(&world, 1);
            apart_m =
                dig_rock_surface_closest(&rock->surface, world.grains.motion[0].x_m, closest_m);
        }
        assert_true(apart_m < GRAIN_m);
        assert_close(world.grains.motion[0].v_mps[2], 0.0, 1e-200);
        dem_run(&world, 1);
        assert_true(world.grains.motion[0].v_mps[2] > 1e-6);
        dig_setup_finish(&world);
    }
}

TEST(the_bucket_feels_the_rock_it_pushes)
{
    static const enum dig_obstacle_shape shape[] = { DIG_OBSTACLE_SPHERE, DIG_OBSTACLE_BOX };
    for (size_t i = 0; i < 2; i++) {
        struct dig_scene scene    = clump_scene(2e-5);
        scene.gravity_mps2        = 1e-300;
        scene.bed.clump.spheres   = 0;
        scene.bed.obstacles       = 1;
        scene.bed.obstacle[0]     = (struct dig_obstacle){ .shape         = shape[i],
                                                           .centre_m      = { 0.03, 0.0, 0.178 },
                                                           .size_m        = { 0.02, 0.03, 0.02 },
                                                           .movable       = true,
                                                           .density_kgpm3 = 2600.0 };
        const double     at[1][3] = { { 0.5, 0.5, 0.5 } };
        const double     no[1][3] = { { 0.0 } };
        struct dig_world world    = make_world(&scene, 1, at, no);
        struct dig_tool  tool     = dig_tool_make(&scene.bucket);
        double           felt_Ns  = 0.0;
        world.tool                = &tool;
        for (int s = 0; s < 10000; s++) {
            const struct dig_pose pose = { .x_m = 0.2 * s * world.dt_s, .z_m = 0.2 };
            dig_tool_place(&tool, pose, 0.2, 0.0, 0.0);
            dig_ode_scene_move(world.bodies->ode, pose, 0.2, 0.0, 0.0);
            dem_run(&world, 1);
            felt_Ns += world.on_tool.f_N[0] * world.dt_s;
        }
        const struct dig_rock *const rock = &world.bodies->obstacles.rock[0];
        assert_true(rock->v_mps[0] > 0.1);
        assert_close(felt_Ns, -rock->mass_kg * rock->v_mps[0], 1e-6 * rock->mass_kg);
        dig_setup_finish(&world);
    }
}
