// Grains of two spheres against LIGGGHTS-PUBLIC 3.8's multisphere bodies.

#include "offline_dem/dig/setup.h"
#include "tests/offline_dem/liggghts_fixture.h"

#define CLUMP_STEP_s 5e-6
#define CLUMPS       4
#define SPHERE_m     0.0031497976 // two, one radius apart, are as large as one of 7.5 mm

static const struct dig_scene scene = {
    .name         = "clumps",
    .bucket       = { .points  = 3,
                      .x_m     = { 0.0, -0.01, -0.01 },
                      .z_m     = { -0.02, -0.01, 0.0 },
                      .width_m = 0.01 },
    .box          = { -0.1, 0.1, -0.1, 0.1, 0.0, 0.1 },
    .packing      = { 0.3, 0.5, 0.3, 0.1, 0.1 },
    .material     = { 2.0 * GRAIN_m, 5e6, 0.2, 0.5, 2.0 },
    .gravity_mps2 = GRAVITY,
    .time_step_s  = CLUMP_STEP_s,
    .output_s     = 0.005,
    .bed.clump    = { .spheres = 2, .x = { -0.5, 0.5 }, .radius = { 1.0, 1.0 } },
    // At walls LIGGGHTS turns the rolling spring otherwise (docs/numerics/dem.md): there is none.
    .bed.pairs    = 1,
    .bed.pair     = { { 0, DIG_MATERIAL_WALLS, 0.5, 0.0, 0.5 } },
    .trajectories = 1,
    .trajectory   = { { .name = "none", .phases = 1, .phase = { { "none", 1.0, 0, 0, 0 } } } },
};

// Where LIGGGHTS had the spheres at step 0, falling as they did there.
static struct dig_world make_world(const struct table *const then, const double rolling)
{
    const struct dig_gravel gravel = { { 0.5, rolling, DENSITY } };
    struct dig_bed          bed;
    assert_int_equal(dig_bed_create((size_t)2 * CLUMPS, false, true, &bed), DIG_OK);
    for (size_t i = 0; i < bed.grains; i++) {
        bed.x_m[i]      = then->value[i][1];
        bed.y_m[i]      = then->value[i][2];
        bed.z_m[i]      = then->value[i][3];
        bed.radius_m[i] = SPHERE_m;
        bed.clump[i]    = (uint32_t)(i / 2 + 1);
    }
    struct dig_world world;
    struct dig_error error    = { "" };
    const double     fall_mps = 0.5 + 0.5 * GRAVITY * CLUMP_STEP_s;
    assert_ok(dig_setup_world(&scene, &gravel, &bed, fall_mps, NULL, &world, &error), error);
    dig_bed_finish(&bed);
    return world;
}

static void follow_spheres(const char *const path, const double rolling)
{
    struct table *const then    = read_table(path);
    struct dig_world    world   = make_world(then, rolling);
    size_t              step    = 0;
    double              moved_m = 0.0;
    for (size_t row = 0; row < then->rows; row++) {
        const size_t at = (size_t)then->value[row][0];
        dem_run(&world, at - step);
        step                         = at;
        const size_t            who  = row % ((size_t)2 * CLUMPS);
        const struct dig_motion ours = *dem_grain(&world, (uint32_t)who);
        for (int k = 0; k < 3; k++) {
            assert_close(ours.x_m[k], then->value[row][1 + k], at <= 2000 ? 1e-7 : 2e-4);
        }
        moved_m = fmax(moved_m, fabs(ours.x_m[0] - then->value[who][1]));
    }
    assert_true(moved_m > 5e-3); // sideways: they have met
    dig_setup_finish(&world);
    free(then);
}

// LIGGGHTS turns its bodies by another scheme, of the same order: seven hundred-thousandths of a
// millimetre after 2000 steps, three contacts on. Then two grains meet that had parted, as in
// test_liggghts.c; a quarter of the way through their tumble, and to its end, they stay within a
// twentieth of a radius of each other. (LIGGGHTS at a fifth of the step parts from itself by a
// fifth of that.)
TEST(clumps_fall_and_turn_as_in_liggghts)
{
    follow_spheres(FOLDER "clumps.csv", 0.0);
}

// Every sphere's rolling torque turns the whole clump.
TEST(clumps_that_resist_rolling_do_so_as_in_liggghts)
{
    follow_spheres(FOLDER "clumps_rolling.csv", 0.5);
}
