// The watch over the time step, on a small poured bed that lies still when it may.

#include "tests/dem_fixture.h"

#include "offline_dem/dig/checked_pour.h"
#include "offline_dem/dig/dig.h"

#define WATCH_s  0.06
#define SETTLE_s 0.3

static struct dig_bed poured;

static int pour(void **state)
{
    (void)state;
    const struct dig_scene  scene  = dem_small_scene();
    const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };
    return dig_bed_pour(NULL, &scene, &gravel, 3, NULL, &poured, NULL);
}

static int empty(void **state)
{
    (void)state;
    dig_bed_finish(&poured);
    return 0;
}

// The bed in its box, moving downwards.
static struct dig_world make_bed(const double fall_mps)
{
    double *const at = calloc(3 * poured.grains, sizeof *at);
    assert_non_null(at);
    double(*const x)[3] = (double(*)[3])at;
    for (size_t i = 0; i < poured.grains; i++) {
        x[i][0] = poured.x_m[i];
        x[i][1] = poured.y_m[i];
        x[i][2] = poured.z_m[i];
    }
    struct dig_world world =
        dem_world(poured.grains, (const double(*)[3])x, dem_material(0.5, 0.5));
    free(at);
    world.gravity_mps2[2] = -GRAVITY;
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    dem_add_wall(&world, -1.0, 0.0, 0.0, -0.06);
    dem_add_wall(&world, 0.0, 1.0, 0.0, -0.0225);
    dem_add_wall(&world, 0.0, -1.0, 0.0, -0.0225);
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    for (size_t i = 0; i < world.grains.n; i++) {
        world.grains.motion[i].v_mps[2] = -fall_mps;
    }
    return world;
}

static bool heats(const double step_s, const double fall_mps, const double watch_s)
{
    struct dig_world world = make_bed(fall_mps);
    world.dt_s             = step_s;
    bool found             = false;
    assert_int_equal(dig_energy_drift_detect(&world, (size_t)(watch_s / step_s), &found), DIG_OK);
    dig_world_finish(&world);
    return found;
}

TEST(a_safe_step_leaves_a_resting_bed_alone)
{
    assert_false(heats(3e-5, 0.0, WATCH_s));
    assert_false(heats(STEP_s, 0.0, WATCH_s));
}

TEST(a_step_that_heats_is_noticed)
{
    assert_true(heats(1e-4, 0.0, WATCH_s));
    assert_true(heats(1.2e-4, 0.0, WATCH_s));
}

// It moves at first, but comes to rest.
TEST(a_bed_that_comes_to_rest_does_not_count)
{
    assert_false(heats(STEP_s, 0.3, SETTLE_s));
}

TEST(a_step_that_explodes_is_an_error_and_writes_nothing)
{
    struct dig_world world = make_bed(0.0);
    world.dt_s             = 5e-3;
    bool found             = false;
    assert_int_equal(dig_energy_drift_detect(&world, 3000, &found), DIG_EINVAL);
    assert_false(found);
    dig_world_finish(&world);
}

TEST(a_scene_whose_step_heats_is_refused_by_name)
{
    const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };
    struct dig_scene        scene  = dem_small_scene();
    struct dig_error        error  = { "" };
    struct dig_bed          bed    = { 0 };
    scene.time_step_s              = 1.2e-4;
    assert_int_equal(dig_bed_pour_checked(NULL, &scene, &gravel, 3, NULL, &bed, &error),
                     DIG_EINVAL);
    assert_non_null(
        strstr(error.text, "time_step_s: 0.00012 keeps a resting bed moving, expected at"));
    assert_null(bed.x_m);

    scene.may_tremble = true;
    assert_int_equal(dig_bed_pour_checked(NULL, &scene, &gravel, 3, NULL, &bed, &error), DIG_OK);
    dig_bed_finish(&bed);
}

// A bed from a file: poured at a step it bears, dug at one it does not, or where no grain can be.
TEST(a_bed_poured_elsewhere_is_refused_as_one_poured_here)
{
    const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };
    struct dig_scene        scene  = dem_small_scene();
    struct dig_error        error  = { "" };
    assert_int_equal(dig_bed_check(&scene, &gravel, &poured, &error), DIG_OK);

    scene.time_step_s = 1.2e-4;
    assert_int_equal(dig_bed_check(&scene, &gravel, &poured, &error), DIG_EINVAL);
    assert_contains(error.text, "time_step_s: 0.00012 keeps a resting bed moving");
    scene.may_tremble = true;
    assert_int_equal(dig_bed_check(&scene, &gravel, &poured, &error), DIG_OK);

    scene            = dem_small_scene();
    const double x_m = poured.x_m[7];
    poured.x_m[7]    = 5.5;
    assert_int_equal(dig_bed_check(&scene, &gravel, &poured, &error), DIG_EINVAL);
    assert_contains(error.text, "bed: grain 7 at (5.5, ");
    poured.x_m[7] = x_m;
    assert_refused(
        dig_bed_check(&scene, &(struct dig_gravel){ { -1.0, 0.5, DENSITY } }, &poured, &error),
        error, DIG_EINVAL, "friction");
}

TEST(what_is_watched_is_poured_as_ever)
{
    const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };
    const struct dig_scene  scene  = dem_small_scene();
    struct dig_bed          bed    = { 0 };
    assert_int_equal(dig_bed_pour_checked(NULL, &scene, &gravel, 3, NULL, &bed, NULL), DIG_OK);
    assert_int_equal(bed.grains, poured.grains);
    assert_memory_equal(bed.x_m, poured.x_m, bed.grains * sizeof *bed.x_m);
    assert_memory_equal(bed.z_m, poured.z_m, bed.grains * sizeof *bed.z_m);
    dig_bed_finish(&bed);
}

TESTS_WITH(pour, empty)
