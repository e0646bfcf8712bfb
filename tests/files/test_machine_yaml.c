// Tests for files/machine_yaml.c and config/machines/

#include "files/machine_yaml.h"

#include "core/units.h"
#include "tests/files/yaml_fixture.h"

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    struct dig_error   error = { "" };
    struct dig_machine m;
    assert_ok(dig_machine_read("tests/data/formats/machine.yaml", &m, &error), error);
    assert_string_equal(m.name, "example 20 t");
    assert_close(m.link[DIG_JOINT_BOOM].length_m, 5.65, 0.0);
    assert_close(m.link[DIG_JOINT_ARM].com_m.y, 0.1, 0.0);
    assert_close(m.link[DIG_JOINT_ARM].min_rad, -155.0 / 180.0 * DIG_PI, 1e-15);
    assert_close(m.link[DIG_JOINT_BUCKET].max_rad, 35.0 / 180.0 * DIG_PI, 1e-15);
    assert_close(m.cylinder[DIG_JOINT_BOOM].count, 2.0, 0.0);
    assert_close(m.cylinder[DIG_JOINT_BOOM].eye_m.x, 2.6, 0.0);
    assert_close(m.cylinder[DIG_JOINT_ARM].base_m.y, 0.9, 0.0);
    assert_close(m.cylinder[DIG_JOINT_ARM].eye_m.x, -0.7, 0.0);
    assert_close(m.cylinder[DIG_JOINT_BUCKET].bore_m, 0.115, 0.0);
    assert_close(m.cylinder[DIG_JOINT_BUCKET].pressure_sigma_Pa, 5e4, 0.0);
    assert_close(m.four_bar.rocker_pin_m.x, 2.5, 0.0);
    assert_close(m.four_bar.ear_m.y, 0.45, 0.0);
    assert_close(m.bucket_width_m, 1.2, 0.0);
    assert_close(m.pressure_step_Pa, 2e5, 0.0);
    assert_close(m.angle_sigma_rad, 1e-3, 0.0);
    assert_close(m.tolerance.pin_m, 1e-3, 0.0);
    assert_close(m.tolerance.mass_share, 0.03, 0.0);
    assert_close(m.tolerance.com_share, 0.01, 0.0);
    assert_close(m.weight_X_m, -1.2, 0.0);
    assert_close(m.boom_foot_Z_m, 1.8, 0.0);
}

static void loads(const char *const path)
{
    struct dig_machine machine;
    struct dig_error   error = { "" };
    assert_ok(dig_machine_read(path, &machine, &error), error);
}

TEST(a_machine_that_says_no_tolerance_has_that_of_a_tape)
{
    size_t      size = 0;
    char *const text = scratch_read("tests/data/formats/machine.yaml", &size);
    char *const other =
        yaml_with(text, "tolerance:\n  pin_m: 1.0e-3\n  mass_share: 0.03\n  com_share: 0.01\n", "");
    struct dig_machine m;
    struct dig_error   error = { "" };
    assert_ok(dig_machine_read(scratch_write("without.yaml", other), &m, &error), error);
    assert_close(m.tolerance.pin_m, 2e-3, 0.0);
    assert_close(m.tolerance.mass_share, 0.05, 0.0);
    assert_close(m.tolerance.com_share, 0.02, 0.0);
    free(other);
    free(text);
}

TEST(every_machine_that_is_shipped_loads)
{
    yaml_loads_all("config/machines", loads);
}

TEST(the_example_of_a_rig_loads_as_it_is_written)
{
    struct dig_error   error = { "" };
    struct dig_machine m;
    assert_ok(dig_machine_read("tests/data/formats/machine_sensor.yaml", &m, &error), error);
    assert_true(m.sensor.fitted);
    assert_close(m.sensor.place_m.x, -0.06, 0.0);
    assert_close(m.sensor.place_m.y, 0.005, 0.0);
    assert_close(m.sensor.turn_rad, DIG_PI / 2.0, 1e-15);
    assert_close(m.sensor.limit_N, 290.0, 0.0);
    assert_close(m.sensor.limit_Nm, 10.0, 0.0);
    assert_close(m.sensor.step_N, 0.125, 0.0);
    assert_close(m.sensor.step_Nm, 0.0025, 0.0);
    assert_close(m.sensor.sigma_N, 0.06, 0.0);
    assert_close(m.sensor.sigma_Nm, 0.001, 0.0);
    assert_close(m.sensor.path_sigma_m, 2e-5, 0.0);
    assert_close(m.link[DIG_JOINT_BUCKET].com_m.y, 0.01, 0.0);
    assert_close(m.angle_sigma_rad, 1e-4, 0.0);
    assert_close(m.bucket_width_m, 0.07, 0.0);

    // It says none: a rig's.
    assert_close(m.tolerance.pin_m, 2e-4, 0.0);
    assert_close(m.tolerance.mass_share, 0.01, 0.0);
    assert_close(m.tolerance.com_share, 0.01, 0.0);
}

static void expect_refusal(const char *const text, const char *const says)
{
    struct dig_error   error = { "" };
    struct dig_machine machine;
    memset(&machine, 0x5a, sizeof machine);
    const struct dig_machine untouched = machine;
    assert_int_equal(dig_machine_read(scratch_write("bad.yaml", text), &machine, &error),
                     DIG_EINVAL);
    assert_memory_equal(&machine, &untouched, sizeof machine);
    assert_contains(error.text, says);
    assert_contains(error.text, "expected");
}

TEST(what_cannot_be_is_refused_with_line_and_key)
{
    static const char *const bad[][3] = {
        { "name: example 20 t", "name: </script>", "name: \"</script>\", expected letters" },
        { "name: example 20 t", "name: \"a\\nb\"", "with a control character or a line break" },
        { "bore_m: 0.12\n", "bore_m: 0\n", "bad.yaml:29: cylinders.boom.bore_m: 0" },
        { "rod_m: 0.08\n", "rod_m: 0.2\n", "bad.yaml:52: cylinders.bucket.rod_m: 0.2" },
        { "max_deg: -30", "max_deg: -170", "arm.max_deg: -170" },
        { "rocker_m: 0.65", "rocker_m: -0.65", "four_bar.rocker_m: -0.65" },
        { "weight_X_m: -1.2", "weight_X_m: 9", "ground.weight_X_m: 9" },
        { "source: round numbers, made up for this example\n", "",
          "bad.yaml:1: source: missing, expected a text" },
        { "base_m: [0.4, 0.6]", "base_m: [0.4, 0.6]\n    eye_m: [0, 0]",
          "cylinders.bucket.eye_m: unknown key" },
        { "angle_step_rad: 4.0e-4", "angle_step_rad: -1", "sensors.angle_step_rad: -1" },
        { "pin_m: 1.0e-3", "pin_m: 1", "bad.yaml:69: tolerance.pin_m: 1, expected" },
        { "mass_share: 0.03", "mass_share: 3", "bad.yaml:70: tolerance.mass_share: 3" },
        { "com_share: 0.01", "com_share: -1", "bad.yaml:71: tolerance.com_share: -1" },
        { "  com_share: 0.01\n", "", "tolerance.com_share: missing, expected a number" },
        // What no part says by itself: core/geometry.h.
        { "max_length_m: 3.0", "max_length_m: 1.74",
          "bad.yaml:34: cylinders.boom.max_length_m: from 1.7 to 1.74, expected to move" },
        { "eye_m: [2.6, 0.6]", "eye_m: [14.6, 0.6]",
          "bad.yaml:34: cylinders.boom.max_length_m: from 1.7 to 3, expected to move" },
        { "com_m: [2.5, 0.3]", "com_m: [25, 0.3]", "bad.yaml:6: boom.com_m: 25 m from the pin" },
        { "link_m: 0.6", "link_m: 0.2", "four_bar: its linkage does not close at " },
        { "base_m: [0.4, -0.3]", "base_m: [0.4, 0.6]",
          "bad.yaml:27: cylinders.boom: a lever of -" },
    };
    yaml_refuses_each("tests/data/formats/machine.yaml", sizeof bad / sizeof bad[0], bad,
                      expect_refusal);
}

TEST(what_no_rig_can_be_is_refused_with_line_and_key)
{
    static const char *const bad[][3] = {
        { "place_m: [-0.06, 0.005]", "place_m: [-60, 5]", "bad.yaml:14: force_sensor.place_m: 60" },
        { "turn_deg: 90", "turn_deg: 900", "force_sensor.turn_deg: 900" },
        { "limit_N: 290", "limit_N: 0", "force_sensor.limit_N: 0" },
        { "limit_Nm: 10", "limit_Nm: -10", "force_sensor.limit_Nm: -10" },
        { "step_N: 0.125", "step_N: 290", "force_sensor.step_N: 290" },
        { "step_Nm: 0.0025", "step_Nm: -1", "force_sensor.step_Nm: -1" },
        { "sigma_N: 0.06", "sigma_N: -1", "force_sensor.sigma_N: -1" },
        { "sigma_Nm: 0.001", "sigma_Nm: 11", "force_sensor.sigma_Nm: 11" },
        { "path_sigma_m: 2.0e-5", "path_sigma_m: -1", "force_sensor.path_sigma_m: -1" },
        { "mass_kg: 0.15", "mass_kg: 0", "bucket.mass_kg: 0" },
        { "inertia_kgm2: 3.0e-4", "inertia_kgm2: 0.3", "bucket.inertia_kgm2: " },
        { "angle_sigma_rad: 1.0e-4", "angle_sigma_rad: -1", "sensors.angle_sigma_rad: -1" },
        { "bucket_width_m: 0.07", "bucket_width_m: 0", "bucket_width_m: 0" },
        { "sensors:\n", "boom: {length_m: 1}\nsensors:\n", "boom: unknown key" },
    };
    yaml_refuses_each("tests/data/formats/machine_sensor.yaml", sizeof bad / sizeof bad[0], bad,
                      expect_refusal);
}

TEST(every_key_is_known_and_needed)
{
    yaml_knows_every_key("tests/data/formats/machine.yaml", expect_refusal);
}

TESTS_WITH(scratch_setup, scratch_teardown)
