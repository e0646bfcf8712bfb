// The paper's models as scenes: config/scenes/paper_*.yaml against its Tables III, IV and VIII.

#include "tests/read.h"

#include <stdio.h>

static void check_material(const struct dig_scene *const scene, const double diameter_m,
                           const double young_Pa, const double poisson, const double restitution)
{
    assert_close(scene->material.diameter_m, diameter_m, 1e-12);
    assert_close(scene->material.young_Pa, young_Pa, 1e-3);
    assert_close(scene->material.poisson, poisson, 1e-12);
    assert_close(scene->material.restitution, restitution, 1e-12);
    assert_close(scene->material.characteristic_velocity_mps, 2.0, 1e-12);
    assert_int_equal(scene->laws.normal, DIG_NORMAL_HOOKE);
    assert_close(scene->laws.cohesion_Jpm3, 0.0, 0.0);
}

TEST(the_basic_model_is_table_iii)
{
    const struct dig_scene scene = read_scene("config/scenes/paper_basic.yaml");
    check_material(&scene, 0.0075, 1e8, 0.3, 0.6);
    assert_int_equal(scene.laws.rolling, DIG_ROLLING_NONE);
    assert_close(scene.time_step_s, 1e-5, 1e-12);
}

TEST(the_rolling_model_is_table_iv)
{
    const struct dig_scene scene = read_scene("config/scenes/paper_rolling.yaml");
    check_material(&scene, 0.0075, 1.5e8, 0.2, 0.2);
    assert_int_equal(scene.laws.rolling, DIG_ROLLING_EPSD2);
}

TEST(the_steel_balls_are_table_viii)
{
    const struct dig_scene scene = read_scene("config/scenes/paper_steel.yaml");
    check_material(&scene, 0.011, 2e9, 0.2, 0.2);
    assert_int_equal(scene.laws.rolling, DIG_ROLLING_EPSD2);
}

// Same bucket, box and trajectories, so that the models can be compared with each other and with
// the reference digs.
TEST(all_are_dug_as_the_rig_is)
{
    const char *const      name[] = { "basic", "rolling", "steel" };
    const struct dig_scene rig    = read_scene("config/scenes/rig.yaml");
    for (size_t k = 0; k < 3; k++) {
        char path[64];
        (void)snprintf(path, sizeof path, "config/scenes/paper_%s.yaml", name[k]);
        const struct dig_scene scene = read_scene(path);
        assert_memory_equal(&scene.bucket, &rig.bucket, sizeof rig.bucket);
        assert_memory_equal(&scene.box, &rig.box, sizeof rig.box);
        assert_int_equal(scene.trajectories, rig.trajectories);
        assert_memory_equal(scene.trajectory, rig.trajectory, sizeof rig.trajectory);
    }
}
