// Tests for core/similar.c: scenes made from one by hand, each with one thing changed.

#include "core/similar.h"

#include "tests/testlib.h"

#include <string.h>

// As the rig: a bucket of 90 mm in a bed of 7.5 mm grains.
static struct dig_scene rig(void)
{
    return (struct dig_scene){
        .name         = "rig",
        .bucket       = { 5,
                          { 0.0, -0.04, -0.052, -0.04, -0.012 },
                          { -0.09, -0.072, -0.042, -0.012, 0.0 },
                          0.07 },
        .box          = { 0.0, 0.31, -0.06, 0.06, 0.0, 0.085 },
        .material     = { 0.0075, 5e6, 0.2, 0.2, 2.0 },
        .gravity_mps2 = 9.81,
        .trajectories = 2,
        .trajectory   = { { "down",
                            -0.2,
                            0.08,
                            0.17,
                            2,
                            { { "in", 0.6, 0.025, -0.045, 0.0 }, { "drag", 2.0, 0.05, 0.0, 0.0 } } },
                          { "turn", -0.5, 0.13, 0.16, 1, { { "turn", 2.5, 0.0, 0.0, 0.35 } } } },
    };
}

// Froude: length l, time sqrt(l), stress l. Powers of four have exact roots.
static struct dig_scene scaled(const double l)
{
    struct dig_scene s        = rig();
    double *const    length[] = { &s.bucket.width_m, &s.box.x_max_m, &s.box.y_min_m,
                                  &s.box.y_max_m,    &s.box.z_max_m, &s.material.diameter_m };
    for (size_t i = 0; i < sizeof length / sizeof length[0]; i++) {
        *length[i] *= l;
    }
    for (size_t i = 0; i < s.bucket.points; i++) {
        s.bucket.x_m[i] *= l;
        s.bucket.z_m[i] *= l;
    }
    s.material.young_Pa *= l;
    s.material.characteristic_velocity_mps *= sqrt(l);
    for (size_t t = 0; t < s.trajectories; t++) {
        s.trajectory[t].start_x_m *= l;
        s.trajectory[t].start_z_m *= l;
        for (size_t i = 0; i < s.trajectory[t].phases; i++) {
            struct dig_phase *const p = &s.trajectory[t].phase[i];
            p->duration_s *= sqrt(l);
            p->vx_mps *= sqrt(l);
            p->vz_mps *= sqrt(l);
            p->omega_radps /= sqrt(l);
        }
    }
    return s;
}

static void expect_similar(const struct dig_scene *const scene)
{
    const struct dig_scene own = rig();
    struct dig_error       e   = { "" };
    assert_ok(dig_scene_similar(scene, &own, &e), e);
}

static void expect_other(const struct dig_scene *const scene, const char *const key)
{
    const struct dig_scene own = rig();
    struct dig_error       e   = { "" };
    assert_refused_by(dig_scene_similar(scene, &own, &e), e, DIG_EINVAL, key);
}

TEST(a_scene_is_similar_to_itself_at_any_size)
{
    const struct dig_scene own = rig();
    for (int i = 0; i < 3; i++) {
        const double           l = (double[]){ 1.0, 4.0, 0.0625 }[i];
        const struct dig_scene s = scaled(l);
        expect_similar(&s);
        assert_close(dig_scene_scale(&s, &own), l, 1e-12);
    }
    struct dig_scene moved = rig();
    moved.box.x_min_m += 3.0;
    moved.box.x_max_m += 3.0;
    moved.box.z_min_m -= 1.0;
    moved.box.z_max_m -= 1.0;
    for (size_t t = 0; t < moved.trajectories; t++) {
        moved.trajectory[t].start_x_m += 3.0;
        moved.trajectory[t].start_z_m -= 1.0;
    }
    expect_similar(&moved);
}

TEST(each_length_may_be_four_per_cent_off_and_not_six)
{
    struct dig_scene s = rig();
    const struct {
        const char *key;
        double     *at;
    } number[] = {
        { "bucket.width_m", &s.bucket.width_m },
        { "box_m.x", &s.box.x_max_m },
        { "box_m.y", &s.box.y_max_m },
        { "box_m.z", &s.box.z_min_m },
        { "material.diameter_m", &s.material.diameter_m },
        { "gravity_mps2", &s.gravity_mps2 },
    };
    // What 1 % of each is: the box's sides are of its extent.
    const double per_cent[] = { 0.0007, 0.0031, 0.0012, -0.00085, 0.000075, 0.0981 };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        *number[i].at += 4.0 * per_cent[i];
        expect_similar(&s);
        *number[i].at += 2.0 * per_cent[i];
        expect_other(&s, number[i].key);
        *number[i].at -= 12.0 * per_cent[i];
        expect_other(&s, number[i].key);
        s = rig();
    }
}

TEST(every_point_of_the_outline_counts_and_how_many_there_are_does_not)
{
    // Each is moved away from the bucket's middle, by a twelfth of its length.
    for (size_t p = 1; p < 5; p++) {
        for (int i = 0; i < 2; i++) {
            const double     l  = i == 0 ? 1.0 : 4.0;
            struct dig_scene s  = scaled(l);
            const double away_m = hypot(s.bucket.x_m[p] / l + 0.02, s.bucket.z_m[p] / l + 0.045);
            s.bucket.x_m[p] += 0.0075 * (s.bucket.x_m[p] + 0.02 * l) / away_m;
            s.bucket.z_m[p] += 0.0075 * (s.bucket.z_m[p] + 0.045 * l) / away_m;
            expect_other(&s, "bucket.profile_m");
        }
    }
    struct dig_scene s = rig();
    s.bucket.points    = 6;
    memmove(s.bucket.x_m + 2, s.bucket.x_m + 1, 4 * sizeof s.bucket.x_m[0]);
    memmove(s.bucket.z_m + 2, s.bucket.z_m + 1, 4 * sizeof s.bucket.z_m[0]);
    s.bucket.x_m[1] = -0.02; // half way between the first two
    s.bucket.z_m[1] = -0.081;
    expect_similar(&s);

    // A plate from tooth to pin, nearly flat, and the same outline cut short at the back.
    s               = rig();
    s.bucket.points = 3;
    s.bucket.x_m[1] = -0.006;
    s.bucket.z_m[1] = -0.045;
    s.bucket.x_m[2] = -0.012;
    s.bucket.z_m[2] = 0.0;
    expect_other(&s, "bucket.profile_m");
    s               = rig();
    s.bucket.points = 4;
    expect_other(&s, "bucket.profile_m");
}

TEST(walls_are_not_sides_that_are_one)
{
    struct dig_scene s = rig();
    s.bed.periodic_y   = true;
    expect_other(&s, "bed.periodic_y: no walls in y, expected walls");
}

TEST(contacts_may_be_somewhat_softer_and_are_to_scale)
{
    struct dig_scene s = rig();
    s.material.young_Pa *= 1.7;
    expect_similar(&s);
    s.material.young_Pa *= 1.1;
    expect_other(&s, "material.young_Pa");
    s = rig();
    s.material.young_Pa /= 1.8;
    expect_other(&s, "material.young_Pa");
    s                   = scaled(4.0);
    s.material.young_Pa = 5e6; // forgotten
    expect_other(&s, "material.young_Pa");

    // A law without that velocity asks not for it; another law, not for the stiffness.
    s                                      = rig();
    s.material.characteristic_velocity_mps = 20.0;
    expect_other(&s, "material.young_Pa");
    s.laws.normal = DIG_NORMAL_HERTZ;
    expect_similar(&s);
    struct dig_error e   = { "" };
    struct dig_scene own = rig();
    own.laws.normal      = DIG_NORMAL_HERTZ;
    assert_int_equal(dig_scene_similar(&s, &own, &e), DIG_OK);
}

TEST(a_trajectory_is_where_the_tables_is_whatever_its_pace)
{
    struct dig_scene s = rig();
    for (size_t i = 0; i < 2; i++) { // twice as fast
        s.trajectory[0].phase[i].duration_s /= 2.0;
        s.trajectory[0].phase[i].vx_mps *= 2.0;
        s.trajectory[0].phase[i].vz_mps *= 2.0;
    }
    expect_similar(&s);

    s = rig();
    s.trajectory[0].start_z_m += 0.006;
    expect_other(&s, "trajectory \"down\"");
    s = rig();
    s.trajectory[1].start_x_m -= 0.006;
    expect_other(&s, "trajectory \"turn\"");
    s = rig();
    s.trajectory[1].phase[0].omega_radps *= 1.1;
    expect_other(&s, "trajectory \"turn\"");
    s = rig();
    s.trajectory[0].theta0_rad += 0.06;
    expect_other(&s, "trajectory \"down\"");

    // Deeper on the way, with the same ends.
    s                               = rig();
    s.trajectory[0].phases          = 3;
    s.trajectory[0].phase[2]        = s.trajectory[0].phase[1];
    s.trajectory[0].phase[1].vz_mps = -0.01;
    s.trajectory[0].phase[2].vz_mps = 0.01;
    s.trajectory[0].phase[1].vx_mps = 0.025;
    s.trajectory[0].phase[2].vx_mps = 0.025;
    expect_other(&s, "trajectory \"down\"");

    // One of another name has nothing to be compared with.
    s = rig();
    memcpy(s.trajectory[1].name, "else", sizeof "else");
    s.trajectory[1].start_z_m += 1.0;
    expect_similar(&s);
}

TEST(what_is_in_the_bed_is_left_to_the_trace)
{
    struct dig_scene s     = rig();
    s.laws.cohesion_Jpm3   = 1e5;
    s.bed.earlier_digs     = 2;
    s.bed.layers           = 1;
    s.material.restitution = 0.5;
    s.packing.settle_s     = 3.0;
    expect_similar(&s);
}

TEST(a_machines_bucket_has_the_shape_of_the_tables)
{
    static struct dig_curve_set set         = { .scene_name     = "rig",
                                                .tooth_m        = 0.09,
                                                .bucket_width_m = 0.07 };
    struct dig_machine          machine     = { .name = "m" };
    struct dig_error            error       = { "" };
    const double                width_m[]   = { 0.777, 0.74, 0.815, 0.73, 0.82, (double)NAN };
    machine.link[DIG_JOINT_BUCKET].length_m = 1.0;
    for (size_t i = 0; i < sizeof width_m / sizeof width_m[0]; i++) {
        machine.bucket_width_m = width_m[i];
        assert_int_equal(dig_bucket_similar(&machine, &set, &error), i < 3 ? DIG_OK : DIG_EINVAL);
    }
    machine.bucket_width_m = 0.9;
    assert_int_equal(dig_bucket_similar(&machine, &set, &error), DIG_EINVAL);
    assert_string_equal(error.text,
                        "scene \"rig\" has a bucket 0.778 times as wide as long, machine "
                        "\"m\" one 0.900 times; expected the same shape within 5 %");
}
