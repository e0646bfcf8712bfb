// The all-ODE reference against the grain kernel: the same motion before rounding has grown.

#include "offline_dem/law/random.h"
#include "offline_dem/reference/ode_bed.h"
#include "offline_dem/reference/ode_history.h"
#include "offline_dem/world/bodies.h"
#include "tests/dem_fixture.h"

#include <math.h>

#define SIDE  5
#define COUNT (SIDE * SIDE * SIDE)

// Grains of three sizes and two densities, thrown about above a floor between four walls.
static struct dig_world heap(const struct dig_law_material *const m)
{
    double                      x[COUNT][3];
    struct dig_random           random = { .state = 7 };
    static const double         size[] = { 0.8, 1.0, 1.3 };
    const struct dig_grain_type plain  = { .radius_m     = GRAIN_m,
                                           .mass_kg      = GRAIN_kg,
                                           .inertia_kgm2 = GRAIN_kgm2 };
    for (size_t i = 0; i < COUNT; i++) {
        const size_t at[3] = { i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE };
        for (size_t k = 0; k < 3; k++) {
            x[i][k] = 2.65 * GRAIN_m * (0.55 + (double)at[k]) +
                      dig_random_between(&random, -0.02, 0.02) * GRAIN_m;
        }
    }
    struct dig_world         world = dem_world(COUNT, (const double(*)[3])x, *m);
    struct dig_grains *const g     = &world.grains;
    g->types                       = 3;
    for (size_t k = 0; k < 3; k++) {
        const double mass = pow(size[k], 3.0) * (k == 2 ? 1.6 : 1.0);
        g->type[k]        = plain;
        g->type[k].radius_m *= size[k];
        g->type[k].mass_kg *= mass;
        g->type[k].inertia_kgm2 *= mass * size[k] * size[k];
    }
    for (size_t i = 0; i < COUNT; i++) {
        g->type_of[i] = (uint8_t)(i * 7 % 3);
        for (size_t k = 0; k < 3; k++) {
            g->motion[i].v_mps[k]   = dig_random_between(&random, -0.5, 0.5);
            g->motion[i].w_radps[k] = dig_random_between(&random, -20.0, 20.0);
        }
        g->motion[i].v_mps[2] -= 0.7;
    }
    dem_set_material(&world, m);
    const double high_m   = 2.65 * GRAIN_m * (SIDE + 0.1);
    world.gravity_mps2[2] = -GRAVITY;
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    dem_add_wall(&world, -1.0, 0.0, 0.0, -high_m);
    dem_add_wall(&world, 0.0, 1.0, 0.0, 0.0);
    dem_add_wall(&world, 0.0, -1.0, 0.0, -high_m);
    return world;
}

static double farthest(const struct dig_world *const world, const struct dig_ode_bed *const bed)
{
    double most_m = 0.0;
    for (uint32_t i = 0; i < world->grains.n; i++) {
        const struct dig_motion        theirs = dig_ode_bed_motion(bed, i);
        const struct dig_motion *const ours   = dem_grain(world, i);
        for (int k = 0; k < 3; k++) {
            most_m = fmax(most_m, fabs(theirs.x_m[k] - ours->x_m[k]));
        }
    }
    return most_m;
}

// Rounding grows to some 1e-14 m within these steps; the heap falls 0.05 m and lies in a jumble.
static void fall_alike(const struct dig_law_material *const m, const size_t steps,
                       const double tolerance_m)
{
    struct dig_world          world = heap(m);
    struct dig_ode_bed *const bed   = dig_ode_bed_create(&world);
    assert_non_null(bed);
    for (size_t s = 0; s < steps; s++) {
        struct dig_wrench on_tool;
        assert_int_equal(dig_ode_bed_step(bed, NULL, &on_tool), DIG_OK);
        dem_run(&world, 1);
    }
    assert_close(farthest(&world, bed), 0.0, tolerance_m);
    dig_ode_bed_destroy(bed);
    dig_world_finish(&world);
}

TEST(a_heap_falls_as_in_the_kernel)
{
    const struct dig_law_material m = dem_material(0.5, 0.5);
    fall_alike(&m, 1000, 1e-11);
}

TEST(a_sticky_heap_under_hertz_falls_as_in_the_kernel)
{
    struct dig_law_material m = dem_material(0.4, 0.3);
    m.normal_law              = DIG_NORMAL_HERTZ;
    m.rolling_law             = DIG_ROLLING_CDT;
    m.cohesion_Jpm3           = 5e4;
    fall_alike(&m, 1000, 1e-11);
}

// A small bucket with a corner, an edge and two sides, as wide as three grains.
static struct dig_tool small_bucket(void)
{
    const struct dig_bucket bucket = {
        .points  = 3,
        .x_m     = { 0.0, -0.012, -0.012 },
        .z_m     = { -0.03, -0.022, 0.0 },
        .width_m = 0.02,
    };
    return dig_tool_make(&bucket);
}

// The heap at rest, as a world that has not been stepped.
static struct dig_world settled(const struct dig_law_material *const m)
{
    struct dig_world world = heap(m);
    dem_run(&world, 4000);
    struct dig_world fresh = heap(m);
    for (uint32_t i = 0; i < COUNT; i++) {
        fresh.grains.motion[i] = (struct dig_motion){ 0 };
        memcpy(fresh.grains.motion[i].x_m, dem_grain(&world, i)->x_m, 3 * sizeof(double));
    }
    dig_world_finish(&world);
    return fresh;
}

// Drags the bucket through the heap while it curls; forces on it at every step.
static void dig_alike(const struct dig_law_material *const m, const size_t steps)
{
    struct dig_world          world = settled(m);
    struct dig_tool           tool  = small_bucket();
    struct dig_ode_bed *const bed   = dig_ode_bed_create(&world);
    assert_non_null(bed);
    world.tool      = &tool;
    double most_N   = 0.0;
    double worst_N  = 0.0;
    double worst_Nm = 0.0;
    for (size_t s = 0; s < steps; s++) {
        const double          t    = (double)s * world.dt_s;
        const struct dig_pose pose = { .x_m       = 0.01 + 0.3 * t,
                                       .z_m       = 0.045 - 0.1 * t,
                                       .theta_rad = -0.3 + 3.0 * t };
        dig_tool_place(&tool, pose, 0.3, -0.1, 3.0);
        struct dig_wrench theirs;
        assert_int_equal(dig_ode_bed_step(bed, &tool, &theirs), DIG_OK);
        dem_run(&world, 1);
        for (int k = 0; k < 3; k++) {
            most_N   = fmax(most_N, fabs(world.on_tool.f_N[k]));
            worst_N  = fmax(worst_N, fabs(theirs.f_N[k] - world.on_tool.f_N[k]));
            worst_Nm = fmax(worst_Nm, fabs(theirs.t_Nm[k] - world.on_tool.t_Nm[k]));
        }
    }
    // The bucket went through grains, and every one of its pushes was the same.
    assert_true(most_N > 20.0 * GRAIN_kg * GRAVITY);
    assert_close(worst_N, 0.0, 1e-9 * most_N);
    assert_close(worst_Nm, 0.0, 1e-9 * most_N * 0.03);
    dig_ode_bed_destroy(bed);
    dig_world_finish(&world);
}

TEST(a_bucket_feels_what_it_feels_in_the_kernel)
{
    const struct dig_law_material m = dem_material(0.5, 0.5);
    dig_alike(&m, 800);
}

TEST(contacts_remember_until_they_end)
{
    struct dig_ode_history map = { 0 };
    assert_null(dig_ode_history_previous(&map, 1, 2));
    // More than the first table holds.
    for (uint32_t a = 0; a < 5000; a++) {
        struct dig_contact_history *const m = dig_ode_history_of(&map, a, a + 1);
        assert_non_null(m);
        assert_close(m->sx_m, 0.0, 0.0);
        m->sx_m = (double)a + 1.0;
    }
    dig_ode_history_end_step(&map);
    for (uint32_t a = 0; a < 5000; a += 2) {
        assert_close(dig_ode_history_of(&map, a, a + 1)->sx_m, (double)a + 1.0, 0.0);
    }
    assert_null(dig_ode_history_previous(&map, 2, 1)); // who touches whom is told apart
    dig_ode_history_end_step(&map);
    assert_close(dig_ode_history_of(&map, 4, 5)->sx_m, 5.0, 0.0);
    assert_close(dig_ode_history_of(&map, 5, 6)->sx_m, 0.0, 0.0); // not touched in between
    dig_ode_history_finish(&map);
}

TEST(a_world_with_clumps_is_refused)
{
    const struct dig_law_material m      = dem_material(0.5, 0.5);
    struct dig_world              world  = heap(&m);
    struct dig_bodies             bodies = { .clumps = 1 };
    world.bodies                         = &bodies;
    assert_null(dig_ode_bed_create(&world));
    world.bodies = NULL;
    dig_world_finish(&world);
}
