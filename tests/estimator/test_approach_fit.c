// Tests for estimator/approach/approach_fit.c: ways driven point by point, by their definition.

#include "estimator/approach/approach_fit.h"

#include "tests/testlib.h"

#include "tests/approach_table.h"

enum { POINTS = DIG_APPROACH_FIT_POINTS };

// The way of a bucket along the trajectory dug so, carried elsewhere, at equal steps of its own
// progress, which are counted out here.
static void drive(const struct dig_trajectory *const t, struct dig_path_point way[const POINTS])
{
    enum { FINE = 20000 };
    const double duration_s = dig_trajectory_duration_s(t);
    double       at_m       = 0.0;
    double       length_m   = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        struct dig_pose before = dig_trajectory_pose(t, 0.0);
        size_t          k      = 0;
        at_m                   = 0.0;
        for (int i = 0; i <= FINE; i++) {
            const struct dig_pose p = dig_trajectory_pose(t, duration_s * i / FINE);
            at_m += hypot(p.x_m - before.x_m, p.z_m - before.z_m) +
                    0.09 * fabs(p.theta_rad - before.theta_rad);
            before = p;
            while (pass == 1 && k < POINTS && at_m >= length_m * (double)k / (POINTS - 1) - 1e-9) {
                way[k++] = (struct dig_path_point){ p.x_m + 0.7, p.z_m - 0.3, 0.09 * p.theta_rad };
            }
        }
        length_m = at_m;
    }
}

TEST(depth_and_attack_are_found_wherever_the_ground_lies)
{
    static const double at[][2] = { { 1.0, 0.0 }, { 1.15, 0.0 }, { 0.8, 4.0 }, { 1.3, -7.0 } };
    for (size_t t = 0; t < 2; t++) {
        const struct dig_trajectory plain = approach_dug(t, dig_approach_plain());
        for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
            struct dig_path_point       way[POINTS];
            struct dig_approach         found;
            const struct dig_approach   made = { at[i][0], at[i][1] * DIG_RAD_PER_DEG };
            const struct dig_trajectory dug  = approach_dug(t, made);
            drive(&dug, way);
            const double off_m = dig_approach_fit(&plain, 0.09, APPROACH_m, way, &found);
            assert_close(found.depth, made.depth, 2e-3);
            assert_close(found.attack_rad, made.attack_rad, 2e-4);
            assert_true(off_m < 5e-5);
        }
    }
}

TEST(a_shaking_way_moves_it_little)
{
    const struct dig_trajectory plain = approach_dug(0, dig_approach_plain());
    const struct dig_trajectory dug   = approach_dug(0, (struct dig_approach){ 1.1, 0.05 });
    struct dig_path_point       way[POINTS];
    struct dig_approach         found;
    drive(&dug, way);
    for (size_t k = 0; k < POINTS; k++) {
        way[k].x_m += 5e-4 * sin(17.0 * (double)k);
        way[k].z_m += 5e-4 * sin(29.0 * (double)k);
        way[k].turn_m += 5e-4 * sin(41.0 * (double)k);
    }
    const double off_m = dig_approach_fit(&plain, 0.09, APPROACH_m, way, &found);
    assert_close(found.depth, 1.1, 0.02);
    assert_close(found.attack_rad, 0.05, 0.002);
    assert_close(off_m, 5e-4 * sqrt(1.5), 1e-4);
}

TEST(another_trajectory_stays_far_away)
{
    const struct dig_trajectory actual = approach_dug(1, dig_approach_plain());
    struct dig_path_point       way[POINTS];
    struct dig_approach         found;
    drive(&actual, way);
    const struct dig_trajectory simple = approach_dug(0, dig_approach_plain());
    assert_true(dig_approach_fit(&simple, 0.09, APPROACH_m, way, &found) > 0.02);
}

TEST(a_trajectory_that_does_not_go_down_has_no_depth)
{
    struct dig_trajectory plain = approach_dug(0, dig_approach_plain());
    struct dig_path_point way[POINTS];
    struct dig_approach   found;
    drive(&plain, way);
    (void)dig_approach_fit(&plain, 0.09, -0.01, way, &found);
    assert_close(found.depth, 1.0, 0.0);
    plain.phase[0].vz_mps = 0.02;
    drive(&plain, way);
    (void)dig_approach_fit(&plain, 0.09, APPROACH_m, way, &found);
    assert_close(found.depth, 1.0, 0.0);
    assert_close(found.attack_rad, 0.0, 1e-4);
}
