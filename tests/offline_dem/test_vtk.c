// Tests for offline_dem/dig/vtk.c: the numbers in a picture are those of the world.

#include "tests/dem_fixture.h"

#include "offline_dem/dig/vtk.h"
#include "offline_dem/world/bodies.h"
#include "tests/scratch.h"

#include <math.h>
#include <stdio.h>

static const struct dig_bucket bucket = { 3, { 0.0, -0.01, 0.0 }, { -0.03, -0.02, 0.0 }, 0.02 };

// What stands after a heading, from its own line on.
static const char *after(const char *const text, const char *const heading)
{
    const char *const at = strstr(text, heading);
    assert_non_null(at);
    return at + strlen(heading);
}

static char *picture(const char *const name)
{
    char   path[64];
    size_t size = 0;
    (void)snprintf(path, sizeof path, "%s_0007.vtk", name);
    return scratch_read(scratch_path(path), &size);
}

TEST(grains_are_drawn_with_what_they_feel)
{
    const double     overlap_m = 0.02 * GRAIN_m;
    const double     x[2][3]   = { { 0.0, 0.0, 0.0 }, { 2.0 * GRAIN_m - overlap_m, 0.0, 0.0 } };
    struct dig_world world     = dem_world(2, x, dem_material(0.5, 0.5));
    struct dig_tool  tool      = dig_tool_make(&bucket);
    world.gravity_mps2[2]      = 0.0;
    dem_run(&world, 1);
    const double d_m       = fabs(dem_grain(&world, 0)->x_m[0] - dem_grain(&world, 1)->x_m[0]);
    const double apart_mps = dem_grain(&world, 1)->v_mps[0] - dem_grain(&world, 0)->v_mps[0];
    const double push_N    = world.pair_law[0].normal_Npm * (2.0 * GRAIN_m - d_m) -
                          world.pair_law[0].damping_Nspm * apart_mps;
    assert_int_equal(dig_vtk_write(scratch_dir, 7, &world, &tool), DIG_OK);
    char *const text = picture("grains");
    double      f[2][3], load[2], v[2][3];
    assert_int_equal(sscanf(after(text, "VECTORS force_N double\n"), "%lf %lf %lf %lf %lf %lf",
                            &f[0][0], &f[0][1], &f[0][2], &f[1][0], &f[1][1], &f[1][2]),
                     6);
    assert_int_equal(sscanf(after(text, "SCALARS load_N double 1\nLOOKUP_TABLE default\n"),
                            "%lf %lf", &load[0], &load[1]),
                     2);
    assert_int_equal(sscanf(after(text, "VECTORS velocity_mps double\n"), "%lf %lf %lf %lf %lf %lf",
                            &v[0][0], &v[0][1], &v[0][2], &v[1][0], &v[1][1], &v[1][2]),
                     6);
    assert_true(push_N > 0.05);
    assert_close(fabs(f[0][0]), push_N, 1e-4 * push_N);
    assert_close(f[0][0] + f[1][0], 0.0, 1e-12);
    assert_close(load[1], 0.5 * push_N, 1e-4 * push_N);
    assert_close(fabs(v[0][0] - v[1][0]), apart_mps, 1e-4 * apart_mps);
    free(text);
    dig_world_finish(&world);
}

TEST(rocks_are_drawn_where_they_are)
{
    const double      x[1][3] = { { 0.0, 0.0, 0.0 } };
    struct dig_world  world   = dem_world(1, x, dem_material(0.5, 0.5));
    struct dig_tool   tool    = dig_tool_make(&bucket);
    struct dig_bodies bodies  = { 0 };
    struct dig_scene  scene   = { .bed.obstacles = 2 };
    scene.bed.obstacle[0]     = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_SPHERE,
                                                       .centre_m = { 1.0, 2.0, 3.0 },
                                                       .size_m   = { 0.5 } };
    scene.bed.obstacle[1]     = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_BOX,
                                                       .centre_m = { -1.0, 0.0, 0.0 },
                                                       .size_m   = { 0.2, 0.4, 0.6 } };
    bodies.obstacles          = dig_obstacles_make(&scene);
    world.bodies              = &bodies;
    assert_int_equal(dig_vtk_write(scratch_dir, 7, &world, &tool), DIG_OK);
    char *const text  = picture("rocks");
    char       *at    = NULL;
    const char *start = after(text, "POINTS ");
    const long  n     = strtol(start, &at, 10);
    at                = strstr(at, "double\n") + 7;
    assert_int_equal(n, 2 * 6 * 49);
    for (long i = 0; i < n; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = strtod(at, &at);
        }
        if (i < n / 2) {
            assert_close(hypot(hypot(p[0] - 1.0, p[1] - 2.0), p[2] - 3.0), 0.25, 1e-5);
        } else {
            const double on[3] = { fabs(p[0] + 1.0) / 0.1, fabs(p[1]) / 0.2, fabs(p[2]) / 0.3 };
            assert_close(fmax(on[0], fmax(on[1], on[2])), 1.0, 1e-5);
        }
    }
    free(text);
    world.bodies = NULL;
    dig_world_finish(&world);
}

TEST(a_folder_that_is_not_there_is_told)
{
    const double     x[1][3] = { { 0.0, 0.0, 0.0 } };
    struct dig_world world   = dem_world(1, x, dem_material(0.5, 0.5));
    struct dig_tool  tool    = dig_tool_make(&bucket);
    assert_int_equal(dig_vtk_write("/nowhere/at/all", 0, &world, &tool), DIG_EIO);
    assert_int_equal(dig_vtk_index("/nowhere/at/all", 3, 0.1, true), DIG_EIO);
    dig_world_finish(&world);
}

TESTS_WITH(scratch_setup, scratch_teardown)
