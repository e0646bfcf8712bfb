#include "core/curve.h"

#include <assert.h>
#include <math.h>
#include <string.h>

const char *dig_channel_name(const enum dig_channel channel)
{
    static const char *const name[DIG_CHANNELS] = { "My_Nm", "Fx_N", "Fz_N", "carried_kg" };
    assert(channel < DIG_CHANNELS);
    return name[channel];
}

static const char *const axis_names[DIG_AXES] = {
    [DIG_AXIS_FRICTION]      = "friction",
    [DIG_AXIS_ROLLING]       = "rolling",
    [DIG_AXIS_DENSITY_kgpm3] = "density_kgpm3",
};

const char *dig_axis_name(const enum dig_axis axis)
{
    assert(axis < DIG_AXES);
    return axis_names[axis];
}

void dig_axes_without_units(char names[const])
{
    static const char unit[] = "_kgpm3";
    assert(names != NULL);
    for (char *at = names; (at = strstr(at, unit)) != NULL;) {
        memmove(at, at + strlen(unit), strlen(at + strlen(unit)) + 1);
    }
}

bool dig_gravel_is_same(const struct dig_gravel *const a, const struct dig_gravel *const b)
{
    assert(a != NULL && b != NULL);
    bool same = true;
    for (int i = 0; i < DIG_AXES; i++) {
        same = same && fabs(a->value[i] - b->value[i]) <= 0.0;
    }
    return same;
}

double dig_curve_mean_square(const float y[const DIG_CURVE_POINTS])
{
    assert(y != NULL);
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += (double)y[k] * (double)y[k];
    }
    return sum / DIG_CURVE_POINTS;
}

double dig_trajectory_duration_s(const struct dig_trajectory *const trajectory)
{
    assert(trajectory != NULL);
    double sum_s = 0.0;
    for (size_t i = 0; i < trajectory->phases; i++) {
        sum_s += trajectory->phase[i].duration_s;
    }
    return sum_s;
}

struct dig_pose dig_trajectory_pose(const struct dig_trajectory *const trajectory,
                                    const double                       time_s)
{
    assert(trajectory != NULL);
    struct dig_pose pose = { trajectory->start_x_m, trajectory->start_z_m, trajectory->theta0_rad };
    double          left_s = time_s;
    for (size_t i = 0; i < trajectory->phases && left_s > 0.0; i++) {
        const struct dig_phase *const phase = &trajectory->phase[i];
        const double                  in_s  = fmin(left_s, phase->duration_s);
        pose.x_m += phase->vx_mps * in_s;
        pose.z_m += phase->vz_mps * in_s;
        pose.theta_rad += phase->omega_radps * in_s;
        left_s -= phase->duration_s;
    }
    return pose;
}

static double path_rate_mps(const struct dig_phase *const phase, const double tooth_m)
{
    return hypot(phase->vx_mps, phase->vz_mps) + tooth_m * fabs(phase->omega_radps);
}

double dig_trajectory_path_m(const struct dig_trajectory *const trajectory, const double tooth_m,
                             const double time_s)
{
    assert(trajectory != NULL);
    double path_m = 0.0;
    double left_s = time_s;
    for (size_t i = 0; i < trajectory->phases && left_s > 0.0; i++) {
        const struct dig_phase *const phase = &trajectory->phase[i];
        path_m += path_rate_mps(phase, tooth_m) * fmin(left_s, phase->duration_s);
        left_s -= phase->duration_s;
    }
    return path_m;
}

double dig_trajectory_time_s(const struct dig_trajectory *const trajectory, const double tooth_m,
                             const double progress)
{
    assert(trajectory != NULL);
    const double duration_s = dig_trajectory_duration_s(trajectory);
    if (!(progress > 0.0)) {
        return 0.0;
    }
    if (progress >= 1.0) {
        return duration_s;
    }

    double left_m = progress * dig_trajectory_path_m(trajectory, tooth_m, duration_s);
    double time_s = 0.0;
    for (size_t i = 0; i < trajectory->phases; i++) {
        const struct dig_phase *const phase    = &trajectory->phase[i];
        const double                  rate_mps = path_rate_mps(phase, tooth_m);
        const double                  length_m = rate_mps * phase->duration_s;
        if (left_m <= length_m && rate_mps > 0.0) {
            return time_s + left_m / rate_mps;
        }
        left_m -= length_m;
        time_s += phase->duration_s;
    }
    return duration_s;
}

size_t dig_trajectory_phase(const struct dig_trajectory *const trajectory, const double time_s)
{
    assert(trajectory != NULL && trajectory->phases > 0);
    double end_s = 0.0;
    for (size_t i = 0; i + 1 < trajectory->phases; i++) {
        end_s += trajectory->phase[i].duration_s;
        if (time_s < end_s) {
            return i;
        }
    }
    return trajectory->phases - 1;
}

// The integral of the piecewise-linear signal from t_s[0] up to at_s, where index i is the last
// sample at or before at_s and area[] would be the running integral up to it.
static double integral_to(const size_t n, const double t_s[], const double y[], const size_t i,
                          const double area_i, const double at_s)
{
    if (i + 1 >= n) {
        return area_i;
    }
    const double part_s = at_s - t_s[i];
    const double slope  = (y[i + 1] - y[i]) / (t_s[i + 1] - t_s[i]);
    return area_i + part_s * (y[i] + 0.5 * slope * part_s);
}

void dig_curve_smooth(const size_t n, const double t_s[], const double y[], const double half_s,
                      double out[])
{
    assert(n == 0 || (t_s != NULL && y != NULL && out != NULL && y != out));
    assert(half_s >= 0.0);

    // Two edges walk along the samples, each with the integral of the signal up to its sample.
    size_t low       = 0;
    size_t high      = 0;
    double low_area  = 0.0;
    double high_area = 0.0;
    for (size_t k = 0; k < n; k++) {
        const double from_s = fmax(t_s[k] - half_s, t_s[0]);
        const double to_s   = fmin(t_s[k] + half_s, t_s[n - 1]);
        while (low + 1 < n && t_s[low + 1] <= from_s) {
            low_area += 0.5 * (y[low] + y[low + 1]) * (t_s[low + 1] - t_s[low]);
            low++;
        }
        while (high + 1 < n && t_s[high + 1] <= to_s) {
            high_area += 0.5 * (y[high] + y[high + 1]) * (t_s[high + 1] - t_s[high]);
            high++;
        }
        out[k] = to_s > from_s ? (integral_to(n, t_s, y, high, high_area, to_s) -
                                  integral_to(n, t_s, y, low, low_area, from_s)) /
                                     (to_s - from_s)
                               : y[k];
    }
}

double dig_curve_noise_left(const size_t n, const double t_s[], const size_t i, const double half_s)
{
    assert(t_s != NULL && i < n);
    const double from_s = fmax(t_s[i] - half_s, t_s[0]);
    const double to_s   = fmin(t_s[i] + half_s, t_s[n - 1]);
    size_t       k      = i;
    double       left   = 0.0;
    if (!(to_s > from_s)) {
        return 1.0;
    }
    while (k > 0 && t_s[k] > from_s) {
        k--;
    }
    for (; k < n && t_s[k] <= to_s; k++) {
        const double before_s = k > 0 ? fmax(t_s[k - 1], from_s) : from_s;
        const double behind_s = k + 1 < n ? fmin(t_s[k + 1], to_s) : to_s;
        const double weight   = 0.5 * fmax(behind_s - before_s, 0.0) / (to_s - from_s);
        left += weight * weight;
    }
    return fmin(left, 1.0);
}

int dig_curve_set_find(const struct dig_curve_set *const set, const char *const name)
{
    for (size_t t = 0; t < set->trajectories; t++) {
        if (strcmp(set->trajectory[t].name, name) == 0) {
            return (int)t;
        }
    }
    return -1;
}
