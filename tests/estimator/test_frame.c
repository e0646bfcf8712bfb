// Tests for estimator/track/frame.c

#include "estimator/track/frame.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

static const double tooth_m = 0.09;
static const double eps     = 1e-12;

static void assert_same(const struct dig_path_point *const a, const struct dig_path_point *const b)
{
    assert_close(a->x_m, b->x_m, eps);
    assert_close(a->z_m, b->z_m, eps);
    assert_close(a->turn_m, b->turn_m, eps);
}

// Nose up by 3-4-5: a pin 5 m ahead and level with the boom's foot is 4 m ahead and 3 m above it.
TEST(nose_up_lifts_what_is_ahead)
{
    const double                pitch_rad = atan2(3.0, 4.0);
    const struct dig_path_point own       = { -0.5, 0.0, tooth_m * 0.2 };
    const struct dig_path_point expected  = { -0.4, 0.3, tooth_m * (0.2 - pitch_rad) };
    const struct dig_path_point world     = dig_frame_turned(&own, pitch_rad, tooth_m);
    assert_same(&world, &expected);
}

TEST(a_route_of_the_world_is_met_in_the_machines_frame_where_it_is_met_in_the_world)
{
    const struct made_options   options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    const struct dig_route      route = dig_route_make(&set->trajectory[MADE_ACTUAL], set->tooth_m);
    for (double pitch_rad = -0.3; pitch_rad < 0.31; pitch_rad += 0.1) {
        const struct dig_route own = dig_frame_route(&route, pitch_rad, set->tooth_m);
        for (double progress = 0.0; progress < 1.0; progress += 0.1) {
            struct dig_path_point at          = dig_route_point(&own, progress);
            at                                = dig_frame_turned(&at, pitch_rad, set->tooth_m);
            const struct dig_path_point there = dig_route_point(&route, progress);
            assert_same(&at, &there);
        }
    }
    made_table_destroy(set);
}

// A force straight down in the world, as a machine whose nose is up by 3-4-5 has it.
TEST(forces_and_their_sigmas_are_turned_with_the_path)
{
    struct dig_window_sample s = { .value = { 7.0, 3.0, -4.0 }, .sigma = { 1.0F, 5.0F, 0.0F } };
    dig_frame_turn_forces(atan2(3.0, 4.0), &s);
    assert_close(s.value[DIG_CHANNEL_MY_Nm], 7.0, eps);
    assert_close(s.value[DIG_CHANNEL_FX_N], 0.0, eps);
    assert_close(s.value[DIG_CHANNEL_FZ_N], -5.0, eps);
    assert_close(s.sigma[DIG_CHANNEL_FX_N], 4.0, 1e-6);
    assert_close(s.sigma[DIG_CHANNEL_FZ_N], 3.0, 1e-6);
}
