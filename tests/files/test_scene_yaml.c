// Tests for files/scene_yaml.c and config/scenes/

#include "core/units.h"
#include "tests/files/yaml_fixture.h"

#define EXAMPLE "tests/data/formats/scene.yaml"

// Where the tooth starts and the pin ends: the first stands in the reference digs' manifest as
// toe_x0_m, the second is the last line of curves/mu0.3_mur0.3_rho2500__actual.csv there.
TEST(the_rig_is_the_scene_of_the_reference_digs)
{
    const struct dig_scene             rig     = read_scene("config/scenes/rig.yaml");
    const struct dig_trajectory *const actual  = dig_scene_find(&rig, "actual");
    const struct dig_trajectory *const simpleA = dig_scene_find(&rig, "simpleA");
    const struct dig_trajectory *const simpleB = dig_scene_find(&rig, "simpleB");
    assert_non_null(actual);
    assert_non_null(simpleA);
    assert_non_null(simpleB);

    const double tooth_m = dig_scene_tooth_m(&rig);
    assert_close(tooth_m, 0.09, 1e-15);
    assert_close(actual->start_x_m + tooth_m * sin(actual->theta0_rad), 0.045, 1e-12);
    assert_close(simpleA->start_x_m + tooth_m * sin(simpleA->theta0_rad), 0.06, 1e-12);
    assert_close(simpleB->start_x_m + tooth_m * sin(simpleB->theta0_rad), 0.09, 1e-12);

    const struct dig_pose end = dig_trajectory_pose(actual, 6.797531);
    assert_close(end.x_m, 0.215512, 2e-6);
    assert_close(end.z_m, 0.194212, 2e-6);
    assert_close(end.theta_rad / DIG_RAD_PER_DEG, 29.823, 1e-4);
    assert_close(rig.box.x_max_m * (rig.box.y_max_m - rig.box.y_min_m) * rig.box.z_max_m,
                 0.31 * 0.12 * 0.085, 1e-15);
    assert_close(rig.material.young_Pa, 5e6, 0.0);
    assert_close(rig.time_step_s, 6.25e-5, 0.0);
    assert_true(rig.may_tremble);
    // The grains poured fill a region 0.196747 m high to .3, over a bed 0.085 m high.
    assert_close(rig.packing.fill_factor * rig.box.z_max_m, 0.3 * 0.196747, 1e-6);
}

static void loads(const char *const path)
{
    (void)read_scene(path);
}

TEST(every_scene_that_is_shipped_loads)
{
    yaml_loads_all("config/scenes", loads);
}

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    const struct dig_scene s = read_scene(EXAMPLE);
    assert_string_equal(s.name, "tub");
    assert_int_equal(s.bucket.points, 4);
    assert_close(s.bucket.x_m[2], -0.12, 0.0);
    assert_close(s.bucket.z_m[2], -0.05, 0.0);
    assert_close(s.box.y_min_m, -0.3, 0.0);
    assert_close(s.packing.relax_s, 0.2, 0.0);
    assert_close(s.material.restitution, 0.2, 0.0);
    assert_int_equal(s.trajectories, 1);
    assert_int_equal(s.trajectory[0].phases, 2);
    assert_string_equal(s.trajectory[0].phase[1].name, "pull");
    assert_close(s.trajectory[0].phase[1].omega_radps, DIG_PI / 18.0, 1e-15);
    assert_close(s.trajectory[0].theta0_rad, -DIG_PI / 12.0, 1e-15);
}

TEST(the_hash_is_of_what_is_meant_not_of_how_it_is_written)
{
    static const char *const same[][2] = {
        { "name: tub\n", "name:   tub # a comment\n" },
        { "source: made up for this example\n", "" },
        { "young_Pa: 5.0e+6", "young_Pa: 5000000" },
        { "x: [0, 1.0]", "x:\n    - 0\n    - 1" },
    };
    yaml_scene_differs_by_each(EXAMPLE, sizeof same / sizeof same[0], same, false);
    static const char *const differs[][2] = {
        { "name: tub", "name: tube" },
        { "young_Pa: 5.0e+6", "young_Pa: 5.1e+6" },
        { "young_Pa: 5.0e+6", "young_Pa: 5.0e+6\n  young_at_kgpm3: 2000" },
        { "x: [0, 1.0]", "x: [0, 1.01]" },
        { "omega_degps: 10", "omega_degps: 10.5" },
    };
    yaml_scene_differs_by_each(EXAMPLE, sizeof differs / sizeof differs[0], differs, true);
}

TEST(what_cannot_be_is_refused_with_line_and_key)
{
    static const char *const bad[][3] = {
        { "young_Pa: 5.0e+6", "young_Pa: -1", "bad.yaml:22: material.young_Pa: -1" },
        { "young_Pa: 5.0e+6", "young_Pa: 5.0e+6\n  young_at_kgpm3: 5",
          "bad.yaml:23: material.young_at_kgpm3: 5, expected > 99" },
        { "y: [-0.3, 0.3]", "y: [0.3, -0.3]", "bad.yaml:12: box_m.y: [0.3, -0.3]" },
        { "y: [-0.3, 0.3]", "y: [0.3]", "bad.yaml:12: box_m.y: 1 values" },
        { "duration_s: 1,", "duration_s: 0,",
          "bad.yaml:35: trajectories[0].phases[1].duration_s: 0" },
        { "output_s: 0.005", "output_s: 0.5", "bad.yaml:28: output_s: 0.5" },
        { "    - [-0.12, -0.2]\n    - [-0.12, -0.05]\n", "",
          "bad.yaml:6: bucket.profile_m: 2 values" },
        { "name: scrape", "name: ''", "bad.yaml:30: trajectories[0].name: nothing" },
        { "name: tub", "name: ../tub", "bad.yaml:1: name: \"../tub\", expected a name of letters" },
        { "name: tub", "name: a`touch OWNED`", "bad.yaml:1: name: \"a`touch OWNED`\"" },
        { "name: tub", "name: \"t\\x1b[2J\"", "bad.yaml:1: name: \"t?[2J\" with a control" },
        { "name: scrape", "name: -rf", "bad.yaml:30: trajectories[0].name: \"-rf\", expected" },
        { "name: pull", "name: a b", "bad.yaml:35: trajectories[0].phases[1].name: \"a b\"" },
    };
    yaml_refuses_each(EXAMPLE, sizeof bad / sizeof bad[0], bad, yaml_scene_refused);
}

TEST(every_key_is_known_and_needed)
{
    yaml_knows_every_key(EXAMPLE, yaml_scene_refused);
}

TESTS_WITH(scratch_setup, scratch_teardown)
