// The reference engine against the kernel on a short dig, and what it refuses.

#include "offline_dem/reference/engine_ode.h"
#include "tests/dem_fixture.h"
#include "tests/offline_dem/rows_agree.h"

static const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };

static struct dig_recording dig_with(const bool ode, const struct dig_scene *const scene,
                                     const struct dig_bed *const bed)
{
    const struct dig_engine            engine = dig_engine_ode();
    const struct dig_trajectory *const t      = &scene->trajectory[0];
    struct dig_recording               r      = { 0 };
    struct dig_error                   error  = { "" };
    assert_ok((ode ? engine.dig(&engine.stepper, scene, &gravel, bed, t, NULL, NULL, &r, &error)
                   : dig_dig_run(NULL, scene, &gravel, bed, t, NULL, NULL, &r, &error)),
              error);
    return r;
}

// Every window of a dig of some thousand steps.
static void digs_agree(const struct dig_scene *const scene)
{
    const struct dig_engine ode = dig_engine_ode();
    struct dig_bed          bed;
    assert_int_equal(ode.pour(&ode.stepper, scene, &gravel, 1, NULL, &bed, NULL), DIG_OK);
    struct dig_recording ours   = dig_with(false, scene, &bed);
    struct dig_recording theirs = dig_with(true, scene, &bed);
    rows_agree(&ours, &theirs);
    dig_recording_finish(&ours);
    dig_recording_finish(&theirs);
    dig_bed_finish(&bed);
}

TEST(a_short_dig_gives_the_kernels_curve)
{
    const struct dig_scene scene = dem_short_dig_scene(0.02);
    digs_agree(&scene);
}

TEST(a_short_dig_in_mixed_sticky_grains_over_a_heavy_layer_gives_the_kernels_curve)
{
    struct dig_scene scene = dem_short_dig_scene(0.02);
    dem_mix_sticky_grains(&scene);
    scene.bed.materials   = 1;
    scene.bed.material[0] = (struct dig_other_material){ "heavy", 0.9, 0.9, 4000.0, 0.2 };
    scene.bed.layers      = 1;
    scene.bed.layer[0]    = (struct dig_layer){ 1, 0.0, 0.015 };
    digs_agree(&scene);
}

// A box that stands fast under the grains, and below the tooth a ball that the bucket
// pushes through the grains.
TEST(a_short_dig_between_rocks_gives_the_kernels_curve)
{
    struct dig_scene scene = dem_short_dig_scene(0.02);
    scene.bed.obstacles    = 2;
    scene.bed.obstacle[0]  = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_BOX,
                                                    .centre_m = { 0.015, 0.005, 0.01 },
                                                    .size_m   = { 0.012, 0.02, 0.01 } };
    scene.bed.obstacle[1]  = (struct dig_obstacle){ .shape         = DIG_OBSTACLE_SPHERE,
                                                    .centre_m      = { 0.036, 0.0, 0.02 },
                                                    .size_m        = { 0.02 },
                                                    .movable       = true,
                                                    .density_kgpm3 = 2500.0 };
    digs_agree(&scene);
}

TEST(a_short_dig_that_moves_a_box_gives_the_kernels_curve)
{
    struct dig_scene scene = dem_short_dig_scene(0.02);
    scene.bed.obstacles    = 1;
    scene.bed.obstacle[0]  = (struct dig_obstacle){ .shape         = DIG_OBSTACLE_BOX,
                                                    .centre_m      = { 0.036, 0.002, 0.021 },
                                                    .size_m        = { 0.016, 0.02, 0.016 },
                                                    .movable       = true,
                                                    .density_kgpm3 = 2500.0 };
    digs_agree(&scene);
}

static void refuses(const struct dig_scene *const scene, const char *const vtk_dir,
                    const char *const key)
{
    const struct dig_engine      ode   = dig_engine_ode();
    const struct dig_bed         bed   = { 0 };
    struct dig_recording         r     = { .rows = 77 };
    struct dig_error             error = { "" };
    const struct dig_trajectory *t     = &scene->trajectory[0];
    assert_int_equal(ode.dig(&ode.stepper, scene, &gravel, &bed, t, vtk_dir, NULL, &r, &error),
                     DIG_EINVAL);
    assert_contains(error.text, key);
    assert_int_equal(r.rows, 77);
}

TEST(what_it_does_not_know_is_refused_by_name)
{
    struct dig_scene scene = dem_short_dig_scene(0.02);
    refuses(&scene, "pictures-go-here", "pictures");
    scene.bed.earlier_digs = 1;
    refuses(&scene, NULL, "earlier_digs");
    scene           = dem_short_dig_scene(0.02);
    scene.bed.clump = (struct dig_clump){ .spheres = 1, .radius = { 1.0 } };
    refuses(&scene, NULL, "clump");
    scene                = dem_short_dig_scene(0.02);
    scene.bed.periodic_y = true;
    scene.box.y_min_m    = -0.05;
    scene.box.y_max_m    = 0.05;
    refuses(&scene, NULL, "periodic_y");
    scene                      = dem_short_dig_scene(0.02);
    scene.trajectory[0].phases = 0;
    refuses(&scene, NULL, "phases");
}

TEST(it_says_which_engine_it_is)
{
    assert_string_equal(dig_engine_ode().name, "ode");
    assert_string_equal(dig_engine_ode().version, dig_engine_kernel().version);
}
