// Tests for closed_loop/recordings/path_depth.c.

#include "closed_loop/recordings/path_depth.h"
#include "tests/testlib.h"

#define TOOTH_m 0.09
#define DEPTH_m 0.026

// In for .6 s, then a drag of 2 s.
static struct dig_trajectory trajectory(const double drag_vz_mps)
{
    return (struct dig_trajectory){
        "drag", -0.26,
        0.08,   0.17,
        2,      { { "in", 0.6, 0.025, -0.0436, 0.0 }, { "drag", 2.0, 0.0463, drag_vz_mps, 0.1 } }
    };
}

// Every tenth of a per cent of the way, with the bucket turned; a part of it is not told.
static void dig(const double drag_vz_mps, const double attack_rad, const double raised_m,
                const double lost_from, const double lost_to, double deeper[DIG_CURVE_POINTS])
{
    const struct dig_trajectory plain = trajectory(0.0);
    const struct dig_trajectory made  = trajectory(drag_vz_mps);
    const struct dig_route      route = dig_route_make(&plain, TOOTH_m);
    struct dig_path_depth       depth = { .poses = { 0 } };
    for (double at = 0.0; at <= 1.0; at += 0.001) {
        if (at > lost_from && at < lost_to) {
            continue;
        }
        const struct dig_pose pose =
            dig_trajectory_pose(&made, dig_trajectory_time_s(&plain, TOOTH_m, at));
        const struct dig_path_point point = { pose.x_m, pose.z_m + raised_m,
                                              TOOTH_m * (pose.theta_rad + attack_rad) };
        dig_path_depth_add(&depth, &route, TOOTH_m, attack_rad, at, &point);
    }
    dig_path_depth_tell(&depth, &route, DEPTH_m, deeper);
}

// Wherever the ground lies, however the bucket is turned, and across what is not told.
TEST(a_drag_that_goes_down_is_ever_deeper)
{
    const struct dig_trajectory plain = trajectory(0.0);
    double                      deeper[DIG_CURVE_POINTS];
    dig(-0.0016, 0.04, 0.3, 0.5, 0.6, deeper);
    // Counted from the mean of the first twentieth of the way behind the first leg.
    const double corner =
        dig_trajectory_path_m(&plain, TOOTH_m, 0.6) / dig_trajectory_path_m(&plain, TOOTH_m, 2.6);
    const double from_m = 0.0016 * 0.025 * 2.0 / (1.0 - corner);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double time_s =
            dig_trajectory_time_s(&plain, TOOTH_m, (double)k / (DIG_CURVE_POINTS - 1));
        const double expected = time_s > 0.6 ? (0.0016 * (time_s - 0.6) - from_m) / DEPTH_m : 0.0;
        assert_close(deeper[k], expected, 0.004);
    }
}

TEST(a_dig_along_its_trajectory_is_no_deeper)
{
    double deeper[DIG_CURVE_POINTS];
    dig(0.0, -0.1, -2.0, 0.2, 0.4, deeper);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(deeper[k], 0.0, 1e-3);
    }
}

TEST(without_the_end_of_the_first_leg_nothing_is_told)
{
    double deeper[DIG_CURVE_POINTS];
    dig(-0.0016, 0.0, 0.0, 0.1, 0.5, deeper);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(deeper[k], 0.0, 0.0);
    }
}
