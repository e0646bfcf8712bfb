// Whole digs in a box of a few hundred grains: what is recorded, what is refused, what repeats.

#include "tests/dem_fixture.h"

#include "offline_dem/dig/dig.h"
#include "offline_dem/world/grain_types.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

static struct dig_scene small_scene(void)
{
    struct dig_scene scene = dem_small_scene();
    scene.box.x_max_m      = 0.08;
    scene.packing.settle_s = 0.3;
    scene.packing.relax_s  = 0.1;

    struct dig_trajectory *const t = &scene.trajectory[0];
    t->start_z_m                   = 0.08;
    t->phases                      = 3;
    t->phase[0]                    = (struct dig_phase){ "down", 0.2, 0.0, -0.13, 0.0 };
    t->phase[1]                    = (struct dig_phase){ "drag", 0.3, 0.06, 0.0, 0.0 };
    t->phase[2]                    = (struct dig_phase){ "curl", 0.1, 0.0, 0.0, 0.5 };
    return scene;
}

static const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };

static struct dig_bed pour(const struct dig_scene *const scene)
{
    struct dig_bed bed;
    assert_int_equal(dig_bed_pour(NULL, scene, &gravel, 1, NULL, &bed, NULL), DIG_OK);
    return bed;
}

TEST(a_dig_is_recorded_from_air_to_its_end)
{
    const struct dig_scene             scene = small_scene();
    const struct dig_trajectory *const t     = &scene.trajectory[0];
    struct dig_bed                     bed   = pour(&scene);
    struct dig_recording               r     = { 0 };
    assert_int_equal(dig_dig_run(NULL, &scene, &gravel, &bed, t, NULL, NULL, &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 120);
    for (size_t k = 0; k < r.rows; k++) {
        // A window holds the forces after its first to after its last step.
        assert_close(r.row[k].t_s, 0.005 * (double)k + 40.5 * STEP_s, 1e-12);
        const struct dig_pose pose = dig_trajectory_pose(t, r.row[k].t_s);
        assert_close(r.row[k].pin_x_m, pose.x_m, 1e-15);
        assert_close(r.row[k].pin_z_m, pose.z_m, 1e-15);
        assert_close(r.row[k].theta_deg, pose.theta_rad / DIG_RAD_PER_DEG, 1e-12);
    }
    // In the air nothing; in the bed the soil lifts the tooth, then holds the drag back.
    assert_close(r.row[2].Fx_N, 0.0, 0.0);
    assert_close(r.row[2].My_Nm, 0.0, 0.0);
    double Fx_N = 0.0, Fz_N = 0.0, My_Nm = 0.0;
    for (size_t k = 60; k < 100; k++) {
        Fx_N += r.row[k].Fx_N;
        My_Nm += r.row[k].My_Nm;
    }
    for (size_t k = 30; k < 40; k++) {
        Fz_N += r.row[k].Fz_N;
    }
    assert_true(Fx_N < 0.0);
    assert_true(My_Nm > 0.0);
    assert_true(Fz_N > 0.0);
    dig_recording_finish(&r);
    dig_bed_finish(&bed);
}

static void expect_refusal(const struct dig_scene *const scene, const struct dig_gravel *const g,
                           const struct dig_bed *const bed, const char *const word)
{
    struct dig_recording r     = { .rows = 77 };
    struct dig_error     error = { { 0 } };
    assert_int_equal(
        dig_dig_run(NULL, scene, g, bed, &scene->trajectory[0], NULL, NULL, &r, &error),
        DIG_EINVAL);
    assert_int_equal(r.rows, 77);
    assert_null(r.row);
    assert_contains(error.text, word);
}

TEST(what_cannot_be_computed_is_refused_by_name)
{
    struct dig_scene     scene = small_scene();
    double               at[2] = { 0.01, 0.03 }, radius[2] = { GRAIN_m, GRAIN_m };
    const struct dig_bed bed = { .grains = 2, .x_m = at, .y_m = at, .z_m = at, .radius_m = radius };

    expect_refusal(&scene, &(struct dig_gravel){ { -0.1, 0.5, DENSITY } }, &bed, "friction");
    expect_refusal(&scene, &(struct dig_gravel){ { 0.5, NAN, DENSITY } }, &bed, "rolling");
    expect_refusal(&scene, &(struct dig_gravel){ { 0.5, 0.5, 0.0 } }, &bed, "density_kgpm3");
    scene.material.young_Pa = -1.0;
    expect_refusal(&scene, &gravel, &bed, "young_Pa");

    struct dig_bed   poured = { .grains = 77 };
    struct dig_error error  = { { 0 } };
    assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, 1, NULL, &poured, &error), DIG_EINVAL);
    assert_int_equal(poured.grains, 77);
    assert_contains(error.text, "young_Pa");

    scene     = small_scene();
    radius[1] = NAN;
    expect_refusal(&scene, &gravel, &bed, "bed");
    radius[1] = GRAIN_m;
    // Two that overlap by a quarter of a radius: the law throws them apart faster than this step
    // can follow. By more than that they are refused.
    scene.time_step_s = 0.01;
    at[1]             = 0.01 + 1.75 * GRAIN_m / sqrt(3.0);
    expect_refusal(&scene, &gravel, &bed, "time_step_s");
}

TEST(what_a_dig_cannot_begin_with_is_refused)
{
    struct dig_scene     scene = small_scene();
    double               at[2] = { 0.01, 0.0101 }, radius[2] = { GRAIN_m, GRAIN_m };
    const struct dig_bed bed = { .grains = 2, .x_m = at, .y_m = at, .z_m = at, .radius_m = radius };
    expect_refusal(&scene, &gravel, &bed, "bed: grains 0 and 1 overlap by ");
    // Behind a wall by more than three tenths of a radius, and nearly so.
    at[0] = 0.69 * GRAIN_m;
    at[1] = 0.02;
    expect_refusal(&scene, &gravel, &bed, "bed: grain 0 at (0.002587, 0.002587, 0.002587) m");
    at[0] = 5.5;
    expect_refusal(&scene, &gravel, &bed, "behind a wall of box_m");
    at[0] = 0.71 * GRAIN_m;
    // Behind the tooth, .036 below the pin at (.03, .053), the second grain is in the bucket's
    // floor.
    scene.trajectory[0].start_z_m       = 0.053;
    scene.trajectory[0].phase[0].vz_mps = 0.0;
    double               y[2]           = { 0.0, 0.01 };
    const struct dig_bed in_way         = {
                .grains = 2, .x_m = at, .y_m = y, .z_m = at, .radius_m = radius
    };
    expect_refusal(&scene, &gravel, &in_way, "starts in the bed");

    scene                               = small_scene();
    scene.trajectory[0].phase[0].vz_mps = -0.3;
    expect_refusal(&scene, &gravel, &bed, "box_m.z");
    scene                                   = small_scene();
    scene.trajectory[0].phase[1].duration_s = 3.0;
    expect_refusal(&scene, &gravel, &bed, "box_m.x");
    scene                = small_scene();
    scene.bucket.width_m = 0.05;
    expect_refusal(&scene, &gravel, &bed, "box_m.y");
}

TEST(a_trajectory_without_phases_is_refused_and_an_empty_bed_is_not)
{
    struct dig_scene     scene = small_scene();
    const struct dig_bed empty = { 0 };
    struct dig_recording r     = { 0 };
    assert_int_equal(
        dig_dig_run(NULL, &scene, &gravel, &empty, &scene.trajectory[0], NULL, NULL, &r, NULL),
        DIG_OK);
    for (size_t k = 0; k < r.rows; k++) {
        assert_close(r.row[k].Fx_N, 0.0, 0.0);
        assert_close(r.row[k].My_Nm, 0.0, 0.0);
    }
    dig_recording_finish(&r);

    struct dig_error            error = { { 0 } };
    const struct dig_trajectory none  = { .name = "none" };
    assert_refused(dig_dig_run(NULL, &scene, &gravel, &empty, &none, NULL, NULL, &r, &error), error,
                   DIG_EINVAL, "trajectory");
    assert_null(r.row);
}

static int stop_soon(void *const context, const double done_s, const double total_s)
{
    int *const calls = context;
    assert_true(done_s >= 0.0 && done_s <= total_s);
    return ++*calls < 3;
}

TEST(a_dig_that_is_stopped_writes_nothing)
{
    const struct dig_scene    scene    = small_scene();
    int                       calls    = 0;
    const struct dig_progress progress = { stop_soon, &calls };
    struct dig_bed            bed      = { .grains = 77 };
    assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, 1, &progress, &bed, NULL), DIG_ESTALE);
    assert_int_equal(bed.grains, 77);
    assert_int_equal(calls, 3);

    bed                    = pour(&scene);
    calls                  = 0;
    struct dig_recording r = { .rows = 77 };
    assert_int_equal(
        dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], NULL, &progress, &r, NULL),
        DIG_ESTALE);
    assert_int_equal(r.rows, 77);
    assert_int_equal(calls, 3);
    dig_bed_finish(&bed);
}

TEST(pictures_are_written_where_they_are_wanted)
{
    const struct dig_scene scene = small_scene();
    double                 x[1] = { 0.03 }, y[1] = { 0.0 }, z[1] = { GRAIN_m }, r[1] = { GRAIN_m };
    const struct dig_bed   bed   = { .grains = 1, .x_m = x, .y_m = y, .z_m = z, .radius_m = r };
    char                   dir[] = "/tmp/dig_test_XXXXXX";
    struct dig_recording   made  = { 0 };
    assert_non_null(mkdtemp(dir));
    assert_int_equal(
        dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], dir, NULL, &made, NULL),
        DIG_OK);
    dig_recording_finish(&made);
    const char *const name[] = { "grains", "bucket" };
    for (int frame = 0; frame < 6; frame++) {
        for (int k = 0; k < 2; k++) {
            char path[128], line[64];
            (void)snprintf(path, sizeof path, "%s/%s_%04d.vtk", dir, name[k], frame);
            FILE *const file = fopen(path, "r");
            assert_non_null(file);
            assert_non_null(fgets(line, sizeof line, file));
            assert_string_equal(line, "# vtk DataFile Version 3.0\n");
            (void)fclose(file);
            (void)unlink(path);
        }
    }
    // The index over time names them all, and nothing else is left.
    for (int k = 0; k < 2; k++) {
        char path[128], text[1024] = "", last[64];
        (void)snprintf(path, sizeof path, "%s/%s.vtk.series", dir, name[k]);
        FILE *const file = fopen(path, "r");
        assert_non_null(file);
        assert_true(fread(text, 1, sizeof text - 1, file) > 0);
        (void)fclose(file);
        (void)snprintf(last, sizeof last, "{\"name\": \"%s_0005.vtk\", \"time\": 0.5}\n]}",
                       name[k]);
        assert_non_null(strstr(text, last));
        assert_null(strstr(text, "_0006"));
        (void)unlink(path);
    }
    assert_int_equal(rmdir(dir), 0);
    // The folder is gone: the dig says so and writes nothing.
    made = (struct dig_recording){ .rows = 77 };
    assert_int_equal(
        dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], dir, NULL, &made, NULL),
        DIG_EIO);
    assert_int_equal(made.rows, 77);
}

static double step_of(const struct dig_scene *const scene)
{
    const struct dig_gravel      dense = { { [DIG_AXIS_DENSITY_kgpm3] = DENSITY } };
    const struct dig_grain_types types = {
        .types = 1, .type = { { .radius_m = 0.5 * scene->material.diameter_m } }
    };
    return dig_grain_types_time_step_s(scene, &dense, &types);
}

// Measured on beds of the reference: quiet at 3.1e-5 s for 5 MPa and 1.25e-5 s for 150 MPa, warming
// up at 2e-5 s for 150 MPa.
TEST(the_derived_step_is_short_enough_and_not_wasteful)
{
    struct dig_scene scene = small_scene();
    assert_close(step_of(&scene), STEP_s, 0.0);
    scene.time_step_s   = 0.0;
    const double soft_s = step_of(&scene);
    assert_true(soft_s > 2.5e-5 && soft_s < 6e-5);
    scene.material.young_Pa = 1.5e8;
    const double stiff_s    = step_of(&scene);
    assert_true(stiff_s > 0.8e-5 && stiff_s <= 1.25e-5);
    // A grain half as large has half the time.
    scene.material.diameter_m *= 0.5;
    assert_close(step_of(&scene), 0.5 * stiff_s, 1e-3 * stiff_s);
}
