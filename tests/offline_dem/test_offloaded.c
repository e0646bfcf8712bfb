// A world that a device steps, the processor standing in for one: digs as the kernel makes them.

#include "offline_dem/device/device_cuda.h"
#include "offline_dem/device/engine_cuda.h"
#include "offline_dem/world/offloaded.h"
#include "tests/dem_fixture.h"
#include "tests/offline_dem/host_device.h"
#include "tests/offline_dem/rows_agree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };

static const struct dig_stepper on_host = { .take_over = dem_host_take_over };

static struct dig_recording dig_on(const struct dig_stepper *const stepper,
                                   const struct dig_scene *const   scene,
                                   const struct dig_bed *const     bed)
{
    struct dig_recording r     = { 0 };
    struct dig_error     error = { "" };
    assert_ok(
        dig_dig_run(stepper, scene, &gravel, bed, &scene->trajectory[0], NULL, NULL, &r, &error),
        error);
    return r;
}

// Some thousand steps, with lists made anew: every window of the dig, before chaos parts them.
static void digs_agree(const struct dig_scene *const scene)
{
    struct dig_bed   bed;
    struct dig_error error = { "" };
    assert_ok(dig_bed_pour(NULL, scene, &gravel, 1, NULL, &bed, &error), error);
    struct dig_recording kernel = dig_on(NULL, scene, &bed);
    struct dig_recording device = dig_on(&on_host, scene, &bed);
    rows_agree(&kernel, &device);
    dig_recording_finish(&kernel);
    dig_recording_finish(&device);
    dig_bed_finish(&bed);
}

TEST(a_short_dig_gives_the_kernels_curve)
{
    const struct dig_scene scene = dem_short_dig_scene(0.03);
    digs_agree(&scene);
}

TEST(so_does_one_in_mixed_sticky_grains)
{
    struct dig_scene scene = dem_short_dig_scene(0.03);
    dem_mix_sticky_grains(&scene);
    digs_agree(&scene);
}

TEST(so_does_one_between_sides_that_are_one_and_over_a_layer)
{
    struct dig_scene scene = dem_short_dig_scene(0.03);
    scene.box.y_min_m      = -0.04;
    scene.box.y_max_m      = 0.04;
    scene.bed.periodic_y   = true;
    scene.bed.materials    = 1;
    scene.bed.material[0]  = (struct dig_other_material){ "hard", 0.9, 0.9, 4000.0, 0.2 };
    scene.bed.layers       = 1;
    scene.bed.layer[0]     = (struct dig_layer){ 1, 0.0, 0.015 };
    digs_agree(&scene);
}

// Clumps of two spheres between two rocks, the one turned; a device does not move rocks.
static struct dig_scene clumps_and_rocks(void)
{
    struct dig_scene scene    = dem_short_dig_scene(0.03);
    scene.bed.clump.spheres   = 2;
    scene.bed.clump.x[0]      = -0.5;
    scene.bed.clump.x[1]      = 0.5;
    scene.bed.clump.radius[0] = 1.0;
    scene.bed.clump.radius[1] = 1.0;
    scene.bed.obstacles       = 2;
    scene.bed.obstacle[0]     = (struct dig_obstacle){
            DIG_OBSTACLE_SPHERE, { 0.055, 0.0, 0.02 }, { 0.016 }, false, 2500.0
    };
    scene.bed.obstacle[1] = (struct dig_obstacle){
        DIG_OBSTACLE_BOX, { 0.015, 0.005, 0.01 }, { 0.012, 0.02, 0.01 }, false, 2500.0
    };
    return scene;
}

TEST(so_does_one_in_clumps_between_rocks)
{
    const struct dig_scene scene = clumps_and_rocks();
    digs_agree(&scene);
}

TEST(so_does_one_in_clumps_between_sides_that_are_one)
{
    struct dig_scene scene = clumps_and_rocks();
    scene.box.y_min_m      = -0.04;
    scene.box.y_max_m      = 0.04;
    scene.bed.periodic_y   = true;
    // Half of it across the side.
    scene.bed.obstacle[1].centre_m[1] = 0.036;
    digs_agree(&scene);
}

// The bucket goes in and comes out, grains are raked and taken away: what the processor does to a
// world in between.
TEST(a_second_dig_in_the_same_bed_goes_on_where_the_first_one_was)
{
    struct dig_scene scene = dem_short_dig_scene(0.03);
    scene.packing.settle_s = 0.02;
    scene.bed.earlier_digs = 1;
    scene.bed.preload_Pa   = 100.0;
    digs_agree(&scene);
}

// One grain led round an edge of the bucket, pressed and unable to turn: what its contact with one
// plate knows goes to the next.
static void lead_round(const double angle_rad, const double w_radps, struct dig_world *const world)
{
    const double      d_m = 0.99 * GRAIN_m;
    const double      c   = cos(angle_rad);
    const double      s   = sin(angle_rad);
    struct dig_motion at  = { .x_m   = { -0.052 + d_m * c, 0.0, -0.042 + d_m * s },
                              .v_mps = { -w_radps * d_m * s, 0.0, w_radps * d_m * c } };
    assert_int_equal(dig_world_sync(world), DIG_OK);
    world->grains.motion[0] = at;
    dig_world_mark_stale(world);
    dem_run(world, 1);
}

TEST(a_contact_goes_on_across_an_edge)
{
    static const struct dig_bucket bucket  = { .points  = 5,
                                               .x_m     = { 0.0, -0.04, -0.052, -0.04, -0.012 },
                                               .z_m     = { -0.09, -0.072, -0.042, -0.012, 0.0 },
                                               .width_m = 0.07 };
    const double                   x[1][3] = { { -0.06, 0.0, -0.042 } };
    struct dig_world               kernel  = dem_world(1, x, dem_material(0.5, 0.0));
    struct dig_world               device  = dem_world(1, x, dem_material(0.5, 0.0));
    struct dig_tool                tool    = dig_tool_make(&bucket);
    kernel.tool                            = &tool;
    device.tool                            = &tool;
    assert_int_equal(dem_host_take_over(&device, NULL), DIG_OK);
    for (double angle = 3.75; angle > 2.5; angle -= 1e-3) {
        struct dig_wrench ours, theirs;
        lead_round(angle, -1e-3 / STEP_s, &kernel);
        lead_round(angle, -1e-3 / STEP_s, &device);
        assert_int_equal(dig_world_take_wrench(&kernel, &ours), DIG_OK);
        assert_int_equal(dig_world_take_wrench(&device, &theirs), DIG_OK);
        assert_true(hypot(ours.f_N[0], ours.f_N[2]) > 0.0);
        for (int k = 0; k < 3; k++) {
            assert_close(theirs.f_N[k], ours.f_N[k], 1e-9);
            assert_close(theirs.t_Nm[k], ours.t_Nm[k], 1e-9);
        }
    }
    dig_world_finish(&kernel);
    dig_world_finish(&device);
}

// A device whose grains never ask for new lists: steps on, and then says that one got away.
static enum dig_status (*real_poll)(struct dig_device *device,
                                    uint32_t           margin_flag[DIG_MARGIN_FLAGS]);

static enum dig_status poll_late(struct dig_device *const device,
                                 uint32_t                 margin_flag[DIG_MARGIN_FLAGS])
{
    const enum dig_status status        = real_poll(device, margin_flag);
    margin_flag[DIG_MARGIN_NEARLY_LEFT] = 0;
    return status;
}

TEST(a_grain_that_got_away_is_refused)
{
    const double             x_m[2][3] = { { 0.0, 0.0, 0.0 }, { 0.1, 0.0, 0.0 } };
    struct dig_world         world     = dem_world(2, x_m, dem_material(0.5, 0.5));
    struct dig_device *const host      = dem_host_device_create();
    assert_non_null(host);
    real_poll             = host->poll_margins;
    host->poll_margins    = poll_late;
    world.gravity_mps2[2] = -GRAVITY;
    assert_int_equal(dig_offload(&world, host), DIG_OK);
    enum dig_status status = DIG_OK;
    size_t          steps  = 0;
    for (; steps < 5000 && status == DIG_OK; steps++) {
        status = dig_world_step(&world);
    }
    assert_int_equal(status, DIG_EINVAL);
    assert_true(steps > 100);
    dig_world_finish(&world);
}

static void skip_without_card(void)
{
    struct dig_error         error = { "" };
    struct dig_device *const card  = dig_device_cuda_create(&error);
    if (card == NULL) {
        print_message("SKIP: %s\n", error.text);
        skip();
    }
    card->destroy(card);
}

// Its sines are its own, so clumps part from the processor's by rounding: slowly, in a short dig.
TEST(a_card_digs_clumps_between_rocks)
{
    skip_without_card();
    const struct dig_engine cuda  = dig_engine_cuda();
    const struct dig_scene  scene = clumps_and_rocks();
    struct dig_bed          bed;
    assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, 1, NULL, &bed, NULL), DIG_OK);
    struct dig_recording ours   = dig_on(NULL, &scene, &bed);
    struct dig_recording theirs = dig_on(&cuda.stepper, &scene, &bed);
    rows_agree(&ours, &theirs);
    dig_recording_finish(&ours);
    dig_recording_finish(&theirs);
    dig_bed_finish(&bed);
}

// Without a card, and where scenes hold what a card does not know. Other tests use the card.
TEST(the_engine_says_what_is_missing)
{
    const char *const       card  = getenv("DIG_CUDA_LIBRARY");
    char *const             own   = strdup(card != NULL ? card : "libdig_cuda.so");
    const struct dig_engine cuda  = dig_engine_cuda();
    struct dig_scene        scene = dem_short_dig_scene(0.03);
    struct dig_error        error = { "" };
    struct dig_bed          bed;
    assert_int_equal(setenv("DIG_CUDA_LIBRARY", "./no-such-library.so", 1), 0);
    assert_int_equal(cuda.pour(&cuda.stepper, &scene, &gravel, 1, NULL, &bed, &error), DIG_EIO);
    assert_contains(error.text, "no-such-library.so");
    assert_int_equal(setenv("DIG_CUDA_LIBRARY", "libm.so.6", 1), 0);
    assert_int_equal(cuda.pour(&cuda.stepper, &scene, &gravel, 1, NULL, &bed, &error), DIG_EIO);
    assert_contains(error.text, "libm.so.6 is not of this build");
    scene.bed.obstacles = 1;
    scene.bed.obstacle[0] =
        (struct dig_obstacle){ DIG_OBSTACLE_SPHERE, { 0.03, 0.0, 0.01 }, { 0.01 }, true, 2500.0 };
    assert_int_equal(cuda.pour(&cuda.stepper, &scene, &gravel, 1, NULL, &bed, &error), DIG_EINVAL);
    assert_contains(error.text, "obstacles[0].movable");
    assert_non_null(own);
    assert_int_equal(setenv("DIG_CUDA_LIBRARY", own, 1), 0);
    free(own);
}

// The card rounds as the processor does and adds in the same order: not a bit may differ.
TEST(a_card_gives_the_bits_of_the_processor)
{
    skip_without_card();
    const struct dig_engine cuda  = dig_engine_cuda();
    struct dig_scene        scene = dem_short_dig_scene(0.03);
    scene.bed.sizes               = 2;
    scene.bed.size[0]             = (struct dig_size){ 0.006, 0.5 };
    scene.bed.size[1]             = (struct dig_size){ 0.0085, 0.5 };
    struct dig_bed a;
    struct dig_bed b;
    assert_int_equal(dig_bed_pour(&on_host, &scene, &gravel, 1, NULL, &a, NULL), DIG_OK);
    assert_int_equal(dig_bed_pour(&cuda.stepper, &scene, &gravel, 1, NULL, &b, NULL), DIG_OK);
    assert_int_equal(b.grains, a.grains);
    assert_memory_equal(b.x_m, a.x_m, a.grains * sizeof *a.x_m);
    assert_memory_equal(b.z_m, a.z_m, a.grains * sizeof *a.z_m);
    struct dig_recording ours   = dig_on(&on_host, &scene, &a);
    struct dig_recording theirs = dig_on(&cuda.stepper, &scene, &b);
    assert_int_equal(theirs.rows, ours.rows);
    assert_memory_equal(theirs.row, ours.row, ours.rows * sizeof *ours.row);
    dig_recording_finish(&ours);
    dig_recording_finish(&theirs);
    dig_bed_finish(&a);
    dig_bed_finish(&b);
}
