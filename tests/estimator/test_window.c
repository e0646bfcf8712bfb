// Test for estimator/track/window.c: each channel is observed with its own sigma. What becomes of
// digs is in test_estimator_digs.c.

#include "estimator/track/window.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

#include <math.h>
#include <string.h>

// A dig whose drive 1 rubs so much, and turns about in the middle of it.
static struct dig_observation observed(const float rubs)
{
    static struct dig_window    window;
    const struct dig_trajectory along = made_trajectory(MADE_SIMPLE_A);
    const struct dig_route      route = dig_route_make(&along, 0.09);
    struct dig_observation      o     = { .dig_count = 0 };
    memset(&window, 0, sizeof window);
    dig_window_open(&window);
    for (int i = 0; i <= 600; i++) {
        const struct dig_pose    pose   = dig_trajectory_pose(&along, i / 200.0);
        const float              now    = i < 300 ? rubs : -rubs;
        struct dig_window_sample sample = { .time_s = i / 200.0,
                                            .pose   = { pose.x_m, pose.z_m, 0.09 * pose.theta_rad },
                                            .has_forces = true,
                                            .value      = { 10.0, 20.0, 30.0 },
                                            .sigma      = { 1.0F, 2.0F, 3.0F },
                                            .slow       = { 0.5F, 1.0F, 1.5F },
                                            .rubs       = { [1] = { now, 0.0F, 2.0F * now } } };
        dig_window_add(&window, &sample);
    }
    assert_int_equal(
        dig_window_observe(&window, &route, &(struct dig_track){ .dx_m = 0.0 }, 0.01, 0.16, &o),
        DIG_OK);
    return o;
}

TEST(every_channel_has_its_own_value_and_sigma)
{
    const struct dig_observation o = observed(0.0F);
    assert_true(o.forces && o.first < 0.01 && o.last > 0.99);
    for (int k = 5; k < DIG_CURVE_POINTS - 5; k++) {
        assert_close(o.moment_Nm[k], 10.0, 1e-9);
        assert_true(o.sigma_Nm[k] > 0.5 && o.sigma_Nm[k] < 0.6);
        for (int c = 0; c < 2; c++) {
            assert_close(o.force_N[c][k], 20.0 + 10.0 * c, 1e-9);
            assert_close(o.force_sigma_N[c][k], (2.0 + c) * o.sigma_Nm[k], 1e-9);
        }
    }
}

// It is smoothed as the channel is, so that there is none where it turns about, and is in the
// sigma.
TEST(friction_is_smoothed_with_its_sign)
{
    const struct dig_observation plain = observed(0.0F);
    const struct dig_observation o     = observed(3.0F);
    double                       least = 3.0;
    for (int k = 5; k < DIG_CURVE_POINTS - 5; k++) {
        const double rubs = (double)o.rubs[1][0][k];
        assert_close(o.moment_Nm[k], plain.moment_Nm[k], 0.0);
        assert_close((double)o.rubs[1][2][k], 2.0 * rubs, 1e-5);
        assert_close((double)o.rubs[1][1][k], 0.0, 0.0);
        assert_close((double)o.rubs[2][0][k], 0.0, 0.0);
        assert_close(o.sigma_Nm[k], hypot(plain.sigma_Nm[k], rubs), 1e-6);
        assert_close(o.force_sigma_N[1][k], hypot(plain.force_sigma_N[1][k], 2.0 * rubs), 1e-5);
        assert_true(k < 60 ? rubs > 2.99 : k > 200 ? rubs < -2.99 : true);
        least = fmin(least, fabs(rubs));
    }
    assert_true(least < 0.3);
}
