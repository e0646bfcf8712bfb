// Tests for core/geometry.c

#include "core/geometry.h"

#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

static void passes(const struct dig_machine *const machine)
{
    struct dig_error error = { "untouched" };
    assert_ok(dig_geometry_check(machine, &error), error);
    assert_string_equal(error.text, "untouched");
}

static void is_refused(const struct dig_machine *const machine, const char *const starts_with)
{
    struct dig_error error = { "" };
    assert_refused_by(dig_geometry_check(machine, &error), error, DIG_EINVAL, starts_with);
    assert_int_equal(dig_geometry_check(machine, NULL), DIG_EINVAL);
}

TEST(what_could_be_built_passes)
{
    const struct dig_machine machine = model_machine();
    passes(&machine);
}

TEST(slips_of_a_digit_a_sign_or_a_unit_are_refused_by_their_key)
{
    const struct dig_machine   good        = model_machine();
    struct dig_machine         m           = good;
    struct dig_cylinder *const boom        = &m.cylinder[DIG_JOINT_BOOM];
    struct dig_cylinder *const arm         = &m.cylinder[DIG_JOINT_ARM];
    struct dig_cylinder *const bucket      = &m.cylinder[DIG_JOINT_BUCKET];
    const double               two_deg_rad = 2.0 * DIG_RAD_PER_DEG;
    const struct {
        const char *says;
        double     *at, wrong;
    } number[] = {
        { "cylinders.boom.max_length_m: from 1.96 to 2, expected to move the boom",
          &boom->max_length_m, boom->min_length_m + 0.04 },
        { "cylinders.arm.max_length_m: from ", &arm->min_length_m, arm->max_length_m - 0.04 },
        { "cylinders.boom.max_length_m: from ", &boom->eye_m.x, 12.0 },
        { "cylinders.bucket.max_length_m: from ", &bucket->base_m.x, -2.7 },
        { "cylinders.arm.max_length_m: 5.6, expected less than twice", &arm->max_length_m, 5.6 },
        { "four_bar: its linkage does not close at ", &m.four_bar.link_m, 0.2 },
        { "boom.com_m: 26 m from the pin, expected at most the 7.06",
          &m.link[DIG_JOINT_BOOM].com_m.x, 26.0 },
        { "arm.inertia_kgm2: 3.08e+04, expected at most", &m.link[DIG_JOINT_ARM].inertia_kgm2,
          30800.0 },
        { "bucket.length_m: 900, expected at most twice the arm's, 5.78",
          &m.link[DIG_JOINT_BUCKET].length_m, 900.0 },
        { "arm.max_deg: 2 degrees above min_deg, expected 10 or more",
          &m.link[DIG_JOINT_ARM].min_rad, m.link[DIG_JOINT_ARM].max_rad - two_deg_rad },
        { "ground.weight_N: 1.599e+04, expected more than the 3.169e+04 N", &m.weight_N, 15990.0 },
    };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        *number[i].at = number[i].wrong;
        is_refused(&m, number[i].says);
        m = good;
    }
}

// A stroke from where the range begins to a part of the way: the lengths are the model's.
TEST(a_stroke_is_half_of_the_range_or_more)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_machine good = model_machine();
        const enum dig_joint     at   = (enum dig_joint)j;
        const double             from = good.link[j].min_rad;
        const double             to   = good.link[j].max_rad;
        const double             a_m  = model_cylinder_m(&good, at, from);
        const double             b_m  = model_cylinder_m(&good, at, to);
        for (int part = 0; part < 2; part++) {
            struct dig_machine m       = good;
            const double       stop    = from + (part == 0 ? 0.55 : 0.45) * (to - from);
            const double       m_m     = model_cylinder_m(&good, at, stop);
            m.cylinder[j].min_length_m = fmin(a_m, b_m > a_m ? a_m : m_m);
            m.cylinder[j].max_length_m = fmax(a_m, b_m > a_m ? m_m : a_m);
            if (part == 0) {
                passes(&m);
            } else {
                is_refused(&m, "cylinders.");
            }
        }
    }
}

// A boom that may rise until its cylinder's lever is this share of the largest.
static struct dig_machine rising_until(const double share)
{
    struct dig_machine m                    = model_machine();
    m.cylinder[DIG_JOINT_BOOM].max_length_m = 3.6; // out of the way: the pins allow 3.37
    const double from_rad                   = m.link[DIG_JOINT_BOOM].min_rad;
    double       most_m                     = 0.0;
    for (int i = 0; i < 6000; i++) {
        const double at_rad  = from_rad + 1e-3 * i;
        const double slope_m = model_slope_m(&m, DIG_JOINT_BOOM, at_rad);
        most_m               = fmax(most_m, slope_m);
        if (slope_m < share * most_m) {
            m.link[DIG_JOINT_BOOM].max_rad = at_rad;
            return m;
        }
    }
    fail_msg("no lever of %g of the largest", share);
    return m;
}

TEST(a_drive_that_comes_to_a_dead_centre_is_refused)
{
    const struct dig_machine near   = rising_until(0.06);
    const struct dig_machine nearer = rising_until(0.04);
    const struct dig_machine over   = rising_until(-0.5);
    passes(&near);
    is_refused(&nearer, "cylinders.boom: a lever of 0.02");
    is_refused(&over, "cylinders.boom: a lever of -0.3");
}

TEST(what_hangs_on_a_sensor_lies_within_reach_of_it)
{
    const struct dig_machine good = {
        .link[DIG_JOINT_BUCKET] = { 0.09, 0.136, { 0.013, 0.017 }, 3.2e-4, -3.0, 3.0 },
        .sensor                 = { .fitted = true, .place_m = { -0.06, 0.0 } },
    };
    passes(&good);
    struct dig_machine m             = good;
    m.link[DIG_JOINT_BUCKET].com_m.x = 13.0;
    is_refused(&m, "bucket.com_m: 13 m from the pin, expected at most the 0.15 m");
    m                                     = good;
    m.link[DIG_JOINT_BUCKET].inertia_kgm2 = 3.2e-2;
    is_refused(&m, "bucket.inertia_kgm2: 0.032, expected at most");
}
