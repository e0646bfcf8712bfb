// Tests for core/curve.c

#include "core/curve.h"

#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

// Down, a turn, a drag, a stand-still, a lift: every kind of phase once.
static const struct dig_trajectory path = {
    .name       = "all",
    .theta0_rad = -0.5,
    .start_x_m  = 0.1,
    .start_z_m  = 0.2,
    .phases     = 5,
    .phase      = {
        { "down", 0.5, 0.03, -0.04, 0.0 },
        { "turn", 1.0, 0.0, 0.0, 0.3 },
        { "drag", 2.0, 0.05, 0.0, 0.0 },
        { "rest", 0.7, 0.0, 0.0, 0.0 },
        { "lift", 0.4, 0.0, 0.09, -0.1 },
    },
};
static const double tooth_m = 0.09;

// Brute force: integrate the rates in small steps.
TEST(pose_and_path_are_the_integral_of_the_rates)
{
    struct dig_pose walked   = { path.start_x_m, path.start_z_m, path.theta0_rad };
    double          walked_m = 0.0, time_s = 0.0;
    const double    step_s = 1e-4;
    for (size_t p = 0; p < path.phases; p++) {
        const struct dig_phase *const phase = &path.phase[p];
        const int                     steps = (int)lround(phase->duration_s / step_s);
        for (int i = 0; i < steps; i++) {
            walked.x_m += phase->vx_mps * step_s;
            walked.z_m += phase->vz_mps * step_s;
            walked.theta_rad += phase->omega_radps * step_s;
            walked_m +=
                step_s * sqrt(phase->vx_mps * phase->vx_mps + phase->vz_mps * phase->vz_mps);
            walked_m += step_s * tooth_m * fabs(phase->omega_radps);
            time_s += step_s;
            if (i % 500 == 250) {
                const struct dig_pose pose = dig_trajectory_pose(&path, time_s);
                assert_close(pose.x_m, walked.x_m, 1e-9);
                assert_close(pose.z_m, walked.z_m, 1e-9);
                assert_close(pose.theta_rad, walked.theta_rad, 1e-9);
                assert_close(dig_trajectory_path_m(&path, tooth_m, time_s), walked_m, 1e-9);
                assert_int_equal(dig_trajectory_phase(&path, time_s), p);
            }
        }
    }
    assert_close(dig_trajectory_duration_s(&path), 4.6, 1e-12);
    assert_close(dig_trajectory_pose(&path, 99.0).z_m, walked.z_m, 1e-9);
    assert_close(dig_trajectory_pose(&path, -1.0).z_m, path.start_z_m, 0.0);
}

TEST(time_of_progress_inverts_the_path)
{
    const double whole_m = dig_trajectory_path_m(&path, tooth_m, 99.0);
    for (int i = 0; i <= 1000; i++) {
        const double progress = i / 1000.0;
        const double time_s   = dig_trajectory_time_s(&path, tooth_m, progress);
        assert_close(dig_trajectory_path_m(&path, tooth_m, time_s), progress * whole_m, 1e-12);
    }
    assert_close(dig_trajectory_time_s(&path, tooth_m, -0.1), 0.0, 0.0);
    assert_close(dig_trajectory_time_s(&path, tooth_m, 1.1), 4.6, 1e-12);
}

// The definition itself, by brute force: the mean of the polyline over the window, in fine steps.
static double mean_by_steps(const size_t n, const double t_s[], const double y[], double from_s,
                            double to_s)
{
    from_s            = fmax(from_s, t_s[0]);
    to_s              = fmin(to_s, t_s[n - 1]);
    const int    many = 200000;
    double       sum  = 0.0;
    size_t       i    = 0;
    const double step = (to_s - from_s) / many;
    for (int k = 0; k < many; k++) {
        const double t = from_s + (k + 0.5) * step;
        while (i + 2 < n && t_s[i + 1] < t) {
            i++;
        }
        sum += y[i] + (y[i + 1] - y[i]) * (t - t_s[i]) / (t_s[i + 1] - t_s[i]);
    }
    return sum / many;
}

TEST(smoothing_is_the_mean_over_the_window_at_uneven_times)
{
    enum { N = 120 };
    double t_s[N], y[N], out[N];
    srand(7);
    for (int i = 0; i < N; i++) {
        t_s[i] = i == 0 ? 3.0 : t_s[i - 1] + 0.001 + 0.02 * rand() / RAND_MAX;
        y[i]   = sin(3.0 * t_s[i]) + 0.3 * rand() / RAND_MAX;
    }
    dig_curve_smooth(N, t_s, y, 0.16, out);
    for (int i = 0; i < N; i += 7) {
        assert_close(out[i], mean_by_steps(N, t_s, y, t_s[i] - 0.16, t_s[i] + 0.16), 1e-5);
    }
}

// A sample's weight is what smoothing makes of it alone.
TEST(noise_is_left_as_the_squares_of_the_weights)
{
    enum { N = 120 };
    double t_s[N], y[N] = { 0.0 }, out[N], squares[N] = { 0.0 };
    double most_off = 0.0;
    srand(8);
    for (int i = 0; i < N; i++) {
        t_s[i] = i == 0 ? 3.0 : t_s[i - 1] + 0.001 + 0.008 * rand() / RAND_MAX;
    }
    for (int one = 0; one < N; one++) {
        y[one] = 1.0;
        dig_curve_smooth(N, t_s, y, 0.1, out);
        y[one] = 0.0;
        for (int i = 0; i < N; i++) {
            squares[i] += out[i] * out[i];
        }
    }
    for (size_t i = 0; i < N; i++) {
        most_off = fmax(most_off, fabs(dig_curve_noise_left(N, t_s, i, 0.1) / squares[i] - 1.0));
    }
    print_message("off by %.3f at most\n", most_off);
    assert_true(most_off < 0.05);
    assert_close(dig_curve_noise_left(N, t_s, 7, 0.0), 1.0, 0.0);
}

TEST(smoothing_keeps_lines_and_zero_width_keeps_all)
{
    double t_s[50], y[50], out[50];
    for (int i = 0; i < 50; i++) {
        t_s[i] = 0.005 * i;
        y[i]   = 2.0 + 3.0 * t_s[i];
    }
    dig_curve_smooth(50, t_s, y, 0.05, out);
    for (int i = 10; i < 40; i++) {
        assert_close(out[i], y[i], 1e-12);
    }
    dig_curve_smooth(50, t_s, y, 0.0, out);
    for (int i = 0; i < 50; i++) {
        assert_close(out[i], y[i], 0.0);
    }
}

TEST(names_of_axes_for_people_are_without_units)
{
    char all[]  = "friction, rolling, density_kgpm3";
    char one[]  = "density_kgpm3, density_kgpm3";
    char none[] = "";
    dig_axes_without_units(all);
    dig_axes_without_units(one);
    dig_axes_without_units(none);
    assert_string_equal(all, "friction, rolling, density");
    assert_string_equal(one, "density, density");
    assert_string_equal(none, "");
}

TEST(gravels_are_the_same_where_every_axis_is)
{
    const struct dig_gravel a = { { 0.5, 0.0, 2500.0 } };
    struct dig_gravel       b = { { 0.5, -0.0, 2500.0 } };
    assert_true(dig_gravel_is_same(&a, &b));
    for (int axis = 0; axis < DIG_AXES; axis++) {
        b             = a;
        b.value[axis] = a.value[axis] + 1e-12 * (1.0 + a.value[axis]);
        assert_false(dig_gravel_is_same(&a, &b));
    }
}

TEST(a_mean_square_is_over_all_points)
{
    float y[DIG_CURVE_POINTS] = { 0.0F };
    y[0]                      = 3.0F;
    y[DIG_CURVE_POINTS - 1]   = -4.0F;
    assert_close(dig_curve_mean_square(y), 25.0 / DIG_CURVE_POINTS, 1e-15);
}
