// Tests for estimator/approach/approach_route.c, and for the turn in estimator/track/track.c.

#include "estimator/approach/approach_route.h"

#include "estimator/approach/approaches.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include "tests/approach_table.h"

#define DEG DIG_RAD_PER_DEG

static struct approach_table table;

static const struct dig_approach cross[] = {
    { 0.8, 0.0 }, { 1.0, -6.0 * DEG }, { 1.0, 6.0 * DEG }, { 1.2, 0.0 }
};

// The vertices of a bucket that digs so, somewhere, seen with noise.
static void drive(const size_t t, const struct dig_approach made, const double noise_m,
                  struct dig_path *const path)
{
    const struct dig_trajectory dug        = approach_dug(t, made);
    const double                duration_s = dig_trajectory_duration_s(&dug);
    uint64_t                    seed       = 7;
    *path                                  = (struct dig_path){ .spacing_m = 0.00225 };
    for (double t_s = 0.06; t_s < duration_s; t_s += 0.005) {
        const struct dig_pose       p     = dig_trajectory_pose(&dug, t_s);
        const struct dig_path_point point = { p.x_m + 0.3 + noise_m * model_normal(&seed),
                                              p.z_m - 0.1 + noise_m * model_normal(&seed),
                                              0.09 * p.theta_rad + noise_m * model_normal(&seed) };
        if (path->vertices == 0) {
            dig_path_add_contact(path, &point);
        }
        (void)dig_path_add(path, &point, true);
    }
}

TEST(a_turned_bucket_is_on_its_path_where_the_table_was_dug_so)
{
    static const double attack[] = { 0.0, 2.5 * DEG, -4.0 * DEG, 5.5 * DEG };
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    for (size_t t = 0; t < 2; t++) {
        const struct dig_route turns = dig_approach_route(&table.cube.set, t);
        const struct dig_route plain = dig_route_make(&table.cube.set.trajectory[t], 0.09);
        assert_close(turns.turn_most_m, 0.09 * 6.0 * DEG, 1e-12);
        assert_close(turns.turn_least_m, -0.09 * 6.0 * DEG, 1e-12);
        for (size_t i = 0; i < sizeof attack / sizeof attack[0]; i++) {
            struct dig_path path;
            drive(t, (struct dig_approach){ 1.0, attack[i] }, 1e-4, &path);
            const struct dig_track found = dig_track_fit(&turns, &path, 0.008);
            assert_close(found.turn_m, 0.09 * attack[i], 3e-4);
            assert_true(found.rms_m < 3e-4);
            const struct dig_track stiff = dig_track_fit(&plain, &path, 0.008);
            assert_close(stiff.turn_m, 0.0, 0.0);
            assert_true(i == 0 || stiff.rms_m > 0.5 * 0.09 * fabs(attack[i]));
        }
        // Beyond what was dug the turn stops, and the rest is distance.
        struct dig_path path;
        drive(t, (struct dig_approach){ 1.0, 10.0 * DEG }, 1e-4, &path);
        const struct dig_track far = dig_track_fit(&turns, &path, 0.008);
        assert_close(far.turn_m, turns.turn_most_m, 1e-12);
        assert_true(far.rms_m > 0.6 * 0.09 * 4.0 * DEG && far.rms_m < 0.0075);
    }
}

TEST(a_track_holds_for_the_route_at_another_depth)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    const struct dig_route plain = dig_approach_route(&table.cube.set, 1);
    const struct dig_route deep  = dig_approach_route_deep(&table.cube.set, 1, 1.2);
    assert_int_equal(deep.corners, plain.corners);
    for (size_t i = 1; i < plain.corners; i++) {
        assert_close(deep.corner[i].x_m, plain.corner[i].x_m, 1e-12);
        assert_close(deep.corner[i].z_m, plain.corner[i].z_m, 1e-12);
        assert_close(deep.corner[i].turn_m, plain.corner[i].turn_m, 1e-12);
    }
    assert_close(deep.corner[0].z_m - plain.corner[0].z_m, 0.2 * APPROACH_m, 1e-9);
    const struct dig_depths depths = dig_approach_depths(&table.cube.set, 1);
    assert_close(depths.least, 0.8, 0.0);
    assert_close(depths.most, 1.2, 0.0);
    table.cube.set.approaches          = NULL;
    const struct dig_depths plain_only = dig_approach_depths(&table.cube.set, 1);
    assert_close(plain_only.least, 1.0, 0.0);
    assert_close(plain_only.most, 1.0, 0.0);
}

// The moment of a dig at `made` over the way of the deepest, the last corners together.
static void over_deepest(const size_t g, const size_t t, const struct dig_approach made,
                         double moment_Nm[const DIG_CURVE_POINTS])
{
    const struct dig_trajectory dug  = approach_dug(t, made);
    const struct dig_trajectory deep = approach_dug(t, cross[3]);
    const double own_m  = dig_trajectory_path_m(&dug, 0.09, dig_trajectory_duration_s(&dug));
    const double deep_m = dig_trajectory_path_m(&deep, 0.09, dig_trajectory_duration_s(&deep));
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_m = deep_m * (double)k / (DIG_CURVE_POINTS - 1) - (deep_m - own_m);
        const double t_s  = dig_trajectory_time_s(&dug, 0.09, at_m / own_m);
        moment_Nm[k] =
            at_m > 0.0
                ? approach_moment_Nm(g, t, t_s, approach_growing(made.depth, made.attack_rad))
                : 0.0;
    }
}

TEST(depth_is_told_by_where_the_soil_begins_to_resist)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    const struct dig_curve_set *const set = &table.cube.set;
    double                            moment_Nm[DIG_CURVE_POINTS];
    for (double depth = 0.75; depth < 1.2; depth += 0.1) {
        for (size_t g = 0; g < CUBE_GRAVELS; g += 3) {
            over_deepest(g, 0, (struct dig_approach){ depth, 2.0 * DEG }, moment_Nm);
            // Each gravel of this table begins to resist in a way of its own.
            assert_close(dig_approach_depth(set, 0, 1.2, 2.0 * DEG, 0.0, 1.0, moment_Nm), depth,
                         0.04);
        }
    }
    // Measured from behind the first leg on, or not so far: it cannot be told.
    assert_close(dig_approach_depth(set, 0, 1.2, 0.0, 0.5, 1.0, moment_Nm), 1.0, 0.0);
    assert_close(dig_approach_depth(set, 0, 1.2, 0.0, 0.0, 0.2, moment_Nm), 1.0, 0.0);
    memset(moment_Nm, 0, sizeof moment_Nm);
    assert_close(dig_approach_depth(set, 0, 1.2, 0.0, 0.0, 1.0, moment_Nm), 1.0, 0.0);
    // Dug at one depth alone.
    approach_table_init(&table, CUBE_GRAVELS, 2, &cross[1], approach_growing, 0.05, 3);
    over_deepest(0, 0, (struct dig_approach){ 1.15, 0.0 }, moment_Nm);
    assert_close(dig_approach_depth(set, 0, 1.0, 0.0, 0.0, 1.0, moment_Nm), 1.0, 0.0);
}
