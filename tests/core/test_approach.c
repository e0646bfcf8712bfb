// Tests for core/approach.c: the tooth's way is followed point by point, which shares nothing with
// how a trajectory is scaled and turned.

#include "core/approach.h"

#include "core/units.h"
#include "tests/read.h"

#include <math.h>
#include <string.h>

struct tooth {
    double x_m, z_m;
};

static struct tooth tooth_at(const struct dig_trajectory *const t, const double time_s)
{
    const struct dig_pose pose = dig_trajectory_pose(t, time_s);
    return (struct tooth){ pose.x_m + 0.09 * sin(pose.theta_rad),
                           pose.z_m - 0.09 * cos(pose.theta_rad) };
}

static struct dig_trajectory make(const struct dig_scene *const scene, const char *const name,
                                  const double depth, const double attack_deg)
{
    const struct dig_approach approach = { depth, attack_deg * DIG_RAD_PER_DEG };
    struct dig_trajectory     made;
    struct dig_error          error = { "" };
    assert_ok(dig_approach_make(scene, dig_scene_find(scene, name), &approach, &made, &error),
              error);
    return made;
}

TEST(the_plain_one_changes_no_bit)
{
    const struct dig_scene scene = read_scene("config/scenes/rig.yaml");
    for (size_t t = 0; t < scene.trajectories; t++) {
        const struct dig_trajectory one  = make(&scene, scene.trajectory[t].name, 1.0, 0.0);
        const struct dig_trajectory zero = make(&scene, scene.trajectory[t].name, 0.0, 0.0);
        assert_memory_equal(&one, &scene.trajectory[t], sizeof one);
        assert_memory_equal(&zero, &scene.trajectory[t], sizeof zero);
    }
}

TEST(depth_is_how_far_the_tooth_goes_down)
{
    const struct dig_scene             scene   = read_scene("config/scenes/rig.yaml");
    const struct dig_trajectory *const plain   = dig_scene_find(&scene, "actual");
    const double                       end_s   = plain->phase[0].duration_s;
    const double                       plain_m = scene.box.z_max_m - tooth_at(plain, end_s).z_m;
    assert_true(plain_m > 0.02);
    for (double depth = 0.7; depth < 1.5; depth += 0.2) {
        const struct dig_trajectory dug = make(&scene, "actual", depth, 0.0);
        assert_close(scene.box.z_max_m - tooth_at(&dug, end_s).z_m, depth * plain_m, 1e-12);
        assert_close(tooth_at(&dug, 0.0).z_m, tooth_at(plain, 0.0).z_m, 1e-15);

        // The direction stays, and what comes behind it is only carried out elsewhere.
        assert_close(dug.phase[0].vx_mps * plain->phase[0].vz_mps,
                     dug.phase[0].vz_mps * plain->phase[0].vx_mps, 1e-15);
        const struct tooth from = tooth_at(&dug, end_s), plain_from = tooth_at(plain, end_s);
        for (double t_s = end_s; t_s < dig_trajectory_duration_s(plain); t_s += 0.1) {
            const struct tooth a = tooth_at(&dug, t_s), b = tooth_at(plain, t_s);
            assert_close(a.x_m - from.x_m, b.x_m - plain_from.x_m, 1e-12);
            assert_close(a.z_m - from.z_m, b.z_m - plain_from.z_m, 1e-12);
        }
    }
}

// The first phase of this one begins 40 mm above the ground and turns, too.
TEST(depth_counts_from_the_ground_and_beside_turning)
{
    struct dig_scene             scene = read_scene("config/scenes/rig.yaml");
    struct dig_trajectory *const t     = &scene.trajectory[0];
    t->start_z_m += 0.04;
    t->phase[0].vz_mps *= 2.5;
    t->phase[0].omega_radps             = 0.3;
    const double                end_s   = t->phase[0].duration_s;
    const double                depth_m = scene.box.z_max_m - tooth_at(t, end_s).z_m;
    const struct dig_trajectory dug     = make(&scene, t->name, 1.3, 0.0);
    assert_true(depth_m > 0.005);
    assert_close(dig_approach_depth_m(&scene, t), depth_m, 1e-12);
    assert_close(scene.box.z_max_m - tooth_at(&dug, end_s).z_m, 1.3 * depth_m, 1e-12);
}

TEST(attack_turns_the_bucket_about_its_tooth)
{
    const struct dig_scene             scene = read_scene("config/scenes/rig.yaml");
    const struct dig_trajectory *const plain = dig_scene_find(&scene, "simpleA");
    const struct dig_trajectory        dug   = make(&scene, "simpleA", 1.0, 5.0);
    for (double t_s = 0.0; t_s < 3.0;
         t_s += 0.25) { // it does not turn: the tooth's way is the same
        const struct tooth a = tooth_at(&dug, t_s), b = tooth_at(plain, t_s);
        assert_close(a.x_m, b.x_m, 1e-12);
        assert_close(a.z_m, b.z_m, 1e-12);
        assert_close(dig_trajectory_pose(&dug, t_s).theta_rad -
                         dig_trajectory_pose(plain, t_s).theta_rad,
                     5.0 * DIG_RAD_PER_DEG, 1e-12);
    }
}

static void refuse(const struct dig_scene *const scene, const struct dig_trajectory *const t,
                   const double depth, const double attack_deg, const char *const says)
{
    const struct dig_approach approach = { depth, attack_deg * DIG_RAD_PER_DEG };
    struct dig_trajectory     made;
    struct dig_error          error = { "" };
    memset(&made, 0x5a, sizeof made);
    const struct dig_trajectory before = made;
    assert_refused(dig_approach_make(scene, t, &approach, &made, &error), error, DIG_EINVAL, says);
    assert_memory_equal(&made, &before, sizeof made);
}

TEST(what_cannot_be_is_refused_by_name)
{
    struct dig_scene             scene = read_scene("config/scenes/rig.yaml");
    struct dig_trajectory *const t     = &scene.trajectory[0];
    refuse(&scene, t, 0.1, 0.0, "trajectory simpleA: depth 0.1, expected 0.2 to 3");
    refuse(&scene, t, NAN, 0.0, "trajectory simpleA: depth nan");
    refuse(&scene, t, 1.0, 50.0, "trajectory simpleA: attack 50 deg, expected -45 to 45");
    refuse(&scene, t, 1.0, NAN, "trajectory simpleA: attack nan");
    refuse(&scene, t, 1.0, 45.0,
           "trajectory simpleA, depth 1, attack 45 deg: the bucket starts 0.00");
    t->phase[0].vz_mps = 0.0;
    refuse(&scene, t, 1.1, 0.0, "its first phase does not go down below the ground");
    t->phase[0].vz_mps = -0.01;
    t->start_z_m += 0.03;
    refuse(&scene, t, 1.1, 0.0, "its first phase does not go down below the ground");
}

TEST(they_differ_by_depth_and_by_attack)
{
    const struct dig_approach approaches[] = {
        { 0.8, 0.0 }, { 1.0, -0.1 }, { 0.0, 0.0 }, { 1.0, 0.1 }, { 1.2, -0.2 }
    };
    for (size_t i = 0; i < 5; i++) {
        for (size_t k = 0; k < 5; k++) {
            assert_int_equal(dig_approach_is_same(&approaches[i], &approaches[k]), i == k);
        }
        assert_int_equal(dig_approach_is_plain(&approaches[i]), i == 2);
    }
    char text[DIG_APPROACH_TEXT_SIZE];
    dig_approach_text(&approaches[2], text);
    assert_string_equal(text, "");
    dig_approach_text(&(struct dig_approach){ 1.15, -5.0 * DIG_RAD_PER_DEG }, text);
    assert_string_equal(text, ", depth 1.15, attack -5 deg");
}
