#include "closed_loop/recordings/regressors.h"

#include "core/units.h"
#include "tests/testlib.h"

#include <string.h>

#define TOOTH_m 0.1

static const double down_mps  = 0.05;
static const double along_mps = 0.2;

// Down for a second, along for five, up for two: the tooth straight below the pin throughout.
static struct dig_curve_set straight(void)
{
    struct dig_curve_set set = {
        .tooth_m      = TOOTH_m,
        .trajectories = 1,
        .trajectory   = { { .start_z_m = 0.3,
                            .phases    = 3,
                            .phase     = { { "in", 1.0, 0.0, -down_mps, 0.0 },
                                           { "drag", 5.0, along_mps, 0.0, 0.0 },
                                           { "out", 2.0, 0.0, down_mps, 0.0 } } } },
    };
    return set;
}

// The point of the grid nearest to a length of the path, of 1.15 m in all.
static size_t point_at(const double path_m)
{
    return (size_t)lround(path_m / 1.15 * (DIG_CURVE_POINTS - 1));
}

TEST(a_straight_drag_is_as_deep_fast_and_full_as_it_was_drawn)
{
    const struct dig_curve_set set = straight();
    const struct dig_measured  dig = { .pass = 3, .pace = 1.0, .last = 1.0 };
    double                     s[DIG_REGRESSORS][DIG_CURVE_POINTS];
    dig_regressors_along(&set, &dig, s);
    const size_t middle = point_at(0.05 + 0.5);
    assert_close(s[DIG_REGRESSOR_PATH][middle], 0.55 / 1.15, 0.002);
    assert_close(s[DIG_STATE_DEPTH_m][middle], 0.05, 1e-9);
    assert_close(s[DIG_STATE_SPEED_mps][middle], along_mps, 1e-9);
    assert_close(s[DIG_STATE_ACCELERATION_mps2][middle], 0.0, 1e-9);
    assert_close(s[DIG_STATE_FILL_m2][middle], 0.05 * 0.5, 2e-4);
    assert_close(s[DIG_REGRESSOR_PASS][middle], 3.0, 0.0);
    // Half way up nothing more is swept, and half of the depth is left.
    const size_t up = point_at(0.05 + 1.0 + 0.025);
    assert_close(s[DIG_STATE_DEPTH_m][up], 0.025, 0.003);
    assert_close(s[DIG_STATE_FILL_m2][up], 0.05, 3e-4);
    assert_close(s[DIG_STATE_SPEED_mps][up], down_mps, 1e-9);
    // Where it turns from down to along the velocity changes within the smoothing.
    const double jump = hypot(along_mps, down_mps) / DIG_SMOOTH_HALF_s;
    const double most = s[DIG_STATE_ACCELERATION_mps2][point_at(0.05)];
    assert_true(most > 0.8 * jump && most <= jump * 1.001);
}

TEST(a_dig_at_twice_the_pace_has_twice_the_speed_and_four_times_the_acceleration)
{
    const struct dig_curve_set set  = straight();
    const struct dig_measured  slow = { .pass = 1, .pace = 1.0, .last = 1.0 };
    const struct dig_measured  fast = { .pass = 1, .pace = 2.0, .last = 1.0 };
    double                     a[DIG_REGRESSORS][DIG_CURVE_POINTS];
    double                     b[DIG_REGRESSORS][DIG_CURVE_POINTS];
    dig_regressors_along(&set, &slow, a);
    dig_regressors_along(&set, &fast, b);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(b[DIG_STATE_SPEED_mps][k], 2.0 * a[DIG_STATE_SPEED_mps][k], 1e-9);
        assert_close(b[DIG_STATE_ACCELERATION_mps2][k], 4.0 * a[DIG_STATE_ACCELERATION_mps2][k],
                     1e-9);
        assert_close(b[DIG_STATE_DEPTH_m][k], a[DIG_STATE_DEPTH_m][k], 0.0);
        assert_close(b[DIG_STATE_FILL_m2][k], a[DIG_STATE_FILL_m2][k], 0.0);
    }
}

// A bucket that only turns moves its tooth on a circle.
TEST(a_turning_tooth_is_drawn_to_its_pin)
{
    const double         omega    = 0.5;
    struct dig_curve_set set      = straight();
    set.trajectory[0].phases      = 1;
    set.trajectory[0].phase[0]    = (struct dig_phase){ "turn", 3.0, 0.0, 0.0, omega };
    const struct dig_measured dig = { .pass = 1, .pace = 1.0, .last = 1.0 };
    double                    s[DIG_REGRESSORS][DIG_CURVE_POINTS];
    dig_regressors_along(&set, &dig, s);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(s[DIG_STATE_SPEED_mps][k], omega * TOOTH_m, 1e-4);
        assert_close(s[DIG_STATE_ACCELERATION_mps2][k], omega * omega * TOOTH_m, 1e-4);
        // It comes up from straight below: never below the ground.
        assert_close(s[DIG_STATE_DEPTH_m][k], 0.0, 1e-12);
    }
}

TEST(only_a_last_phase_that_rises_is_lifted)
{
    struct dig_curve_set set = straight();
    assert_false(dig_regressors_is_lifted(&set, 0, 0.02));
    assert_false(dig_regressors_is_lifted(&set, 0, 0.5));
    assert_true(dig_regressors_is_lifted(&set, 0, 0.99));
    set.trajectory[0].phase[2].vz_mps = 0.0;
    assert_false(dig_regressors_is_lifted(&set, 0, 0.99));
}

TEST(every_state_has_a_name_of_its_own)
{
    for (int a = 0; a < DIG_REGRESSORS; a++) {
        for (int b = 0; b < a; b++) {
            assert_string_not_equal(dig_regressors_name((enum dig_regressors)a),
                                    dig_regressors_name((enum dig_regressors)b));
        }
    }
}
