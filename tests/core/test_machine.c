// Tests for core/machine.c and core/sample.c

#include "core/machine.h"

#include "core/sample.h"
#include "tests/testlib.h"

#include <string.h>

static struct dig_machine plausible(void)
{
    struct dig_machine m = { .name                  = "test",
                             .bucket_width_m        = 0.7,
                             .weight_N              = 1.5e5,
                             .weight_X_m            = -1.0,
                             .tip_front_X_m         = 1.5,
                             .tip_rear_X_m          = -2.5,
                             .boom_foot_Z_m         = 1.8,
                             .four_bar.rocker_m     = 0.6,
                             .four_bar.link_m       = 0.6,
                             .four_bar.ear_m        = { 0.1, 0.4 },
                             .four_bar.rocker_pin_m = { 2.0, 0.1 } };
    for (int j = 0; j < DIG_JOINTS; j++) {
        m.link[j]     = (struct dig_link){ 3.0, 500.0, { 1.0, 0.1 }, 200.0, -1.0, 1.0 };
        m.cylinder[j] = (struct dig_cylinder){ .count             = 1.0,
                                               .bore_m            = 0.12,
                                               .rod_m             = 0.085,
                                               .relief_Pa         = 34e6,
                                               .back_Pa           = 5e5,
                                               .min_length_m      = 1.0,
                                               .max_length_m      = 2.0,
                                               .pressure_sigma_Pa = 1e4 };
    }
    return m;
}

TEST(a_plausible_machine_passes)
{
    const struct dig_machine m = plausible();
    struct dig_error         e = { "untouched" };
    assert_int_equal(dig_machine_check(&m, &e), DIG_OK);
    assert_string_equal(e.text, "untouched");
}

static void expect_refusal(const struct dig_machine *const m, const char *const starts_with)
{
    struct dig_error e = { "" };
    assert_refused_by(dig_machine_check(m, &e), e, DIG_EINVAL, starts_with);
}

TEST(what_cannot_be_is_refused_by_its_key)
{
    struct dig_machine m = plausible();
    const struct {
        const char *key;
        double     *at, wrong;
    } number[] = {
        { "boom.length_m: 3620, expected metres", &m.link[0].length_m, 3620.0 },
        { "boom.length_m: nan", &m.link[0].length_m, NAN },
        { "arm.mass_kg: 0", &m.link[1].mass_kg, 0.0 },
        { "bucket.max_deg", &m.link[2].max_rad, m.link[2].min_rad },
        { "cylinders.boom.bore_m: ", &m.cylinder[0].bore_m, NAN },
        { "cylinders.bucket.rod_m", &m.cylinder[2].rod_m, m.cylinder[2].bore_m },
        { "cylinders.arm.max_length_m", &m.cylinder[1].max_length_m, 0.5 },
        { "cylinders.arm.back_Pa", &m.cylinder[1].back_Pa, 35e6 },
        { "four_bar.ear_m", &m.four_bar.ear_m.x, INFINITY },
        { "ground.weight_X_m", &m.weight_X_m, 9.0 },
        { "sensors.pressure_step_Pa", &m.pressure_step_Pa, -1.0 },
    };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        *number[i].at = number[i].wrong;
        expect_refusal(&m, number[i].key);
        m = plausible();
    }
}

// 4 x area / pi is the square of the diameter; the annulus is the difference of two squares.
TEST(areas_are_those_of_circles)
{
    const struct dig_machine m = plausible();
    assert_close(dig_cylinder_head_m2(&m.cylinder[0]), 113.0973355e-4, 1e-11);
    assert_close(dig_cylinder_rod_m2(&m.cylinder[0]), 113.0973355e-4 - 56.7450173e-4, 1e-11);
}

TEST(every_signal_has_a_name_that_finds_it)
{
    for (int i = 0; i < DIG_SIGNALS; i++) {
        assert_int_equal(dig_signal_find(dig_signal_name((enum dig_signal)i)), i);
    }
    assert_int_equal(dig_signal_find("boom"), -1);
    assert_null(dig_signal_name(DIG_SIGNALS));
}

TEST(a_sample_is_complete_without_the_optional_signals_only)
{
    struct dig_sample s = { 0 };
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        s.valid[i] = true;
    }
    assert_true(dig_sample_is_complete(&s));
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        s.valid[i] = false;
        assert_false(dig_sample_is_complete(&s));
        s.valid[i] = true;
    }
}

TEST(angles_and_the_buckets_pressures_tell_the_moment)
{
    struct dig_sample s = { 0 };
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        s.valid[i] = true;
    }
    for (int i = 0; i < DIG_SIGNALS; i++) {
        const bool other =
            (i >= DIG_SIGNAL_BOOM_HEAD_Pa && i <= DIG_SIGNAL_ARM_ROD_Pa) || i >= DIG_SIGNALS_NEEDED;
        const bool was = s.valid[i];
        s.valid[i]     = false;
        assert_true(dig_sample_has_moment(&s) == other);
        s.valid[i] = was;
    }
}

TEST(what_is_missing_is_named)
{
    bool valid[DIG_SIGNALS];
    char text[DIG_SIGNAL_NAMES_SIZE];
    for (int i = 0; i < DIG_SIGNALS; i++) {
        valid[i] = i < DIG_SIGNALS_NEEDED; // the optional ones are never missed
    }
    dig_signal_name_missing(valid, sizeof text, text);
    assert_string_equal(text, "");
    valid[DIG_SIGNAL_BOOM_ROD_Pa] = valid[DIG_SIGNAL_ARM_HEAD_Pa] = false;
    dig_signal_name_missing(valid, sizeof text, text);
    assert_string_equal(text, "boom_rod_Pa, arm_head_Pa");
    char cut[16];
    dig_signal_name_missing(valid, sizeof cut, cut);
    assert_string_equal(cut, "boom_rod_Pa, ar");
    memset(valid, 0, sizeof valid);
    dig_signal_name_missing(valid, sizeof text, text);
    assert_non_null(strstr(text, "bucket_rod_Pa")); // all nine have room
}

// Of a rig all that it has is needed; nothing of a machine with cylinders may be there beside it.
TEST(a_force_sensor_tells_the_moment_with_the_pin_and_the_buckets_angle)
{
    static const enum dig_signal needed[] = {
        DIG_SIGNAL_BUCKET_rad,  DIG_SIGNAL_PIN_X_m,     DIG_SIGNAL_PIN_Z_m,
        DIG_SIGNAL_SENSOR_FX_N, DIG_SIGNAL_SENSOR_FZ_N, DIG_SIGNAL_SENSOR_MY_Nm,
    };
    struct dig_sample s = { 0 };
    for (int i = 0; i < 6; i++) {
        s.valid[needed[i]] = true;
    }
    assert_int_equal(dig_signals_sensing(s.valid), DIG_SENSING_SENSOR);
    assert_true(dig_sample_has_moment(&s) && dig_sample_is_complete(&s));
    for (int i = 0; i < 6; i++) {
        char text[DIG_SIGNAL_NAMES_SIZE];
        s.valid[needed[i]] = false;
        assert_false(dig_sample_has_moment(&s) || dig_sample_is_complete(&s));
        dig_signal_name_missing(s.valid, sizeof text, text);
        assert_string_equal(text, dig_signal_name(needed[i]));
        s.valid[needed[i]] = true;
    }
    s.valid[DIG_SIGNAL_ARM_HEAD_Pa] = true;
    assert_int_equal(dig_signals_sensing(s.valid), DIG_SENSING_CYLINDERS);
    assert_false(dig_sample_has_moment(&s));
}
