// Ground that resists more when it is dug faster. No bed needed: every force grows
// as (pace speed^along)^exponent. pace 1 is the table's own; speed is that of the tooth at this
// point of the path, over the mean of the table's trajectories: with along 1 the ground depends on
// the tooth's local speed, with along 0 on the pace of the whole dig. It shows only over digs of
// different pace.

#include "estimator/effects/list.h"

#include <assert.h>
#include <math.h>

enum { EXPONENT, ALONG, PARAMETERS };

static const double half_s = 0.16; // half the smoothing of curves
static const double step_s = 0.01;

// Least speed, over the mean: the tooth rests for an instant where it reverses.
static const double least_speed = 0.1;

// Path length of the tooth between two times, step by step.
static double path_m(const struct dig_trajectory *const t, const double tooth_m,
                     const double from_s, const int steps)
{
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        const struct dig_pose a = dig_trajectory_pose(t, from_s + (double)i * step_s);
        const struct dig_pose b = dig_trajectory_pose(t, from_s + (double)(i + 1) * step_s);

        const double x_m = b.x_m - a.x_m + tooth_m * (sin(b.theta_rad) - sin(a.theta_rad));
        const double z_m = b.z_m - a.z_m - tooth_m * (cos(b.theta_rad) - cos(a.theta_rad));
        sum += hypot(x_m, z_m);
    }
    return sum;
}

void dig_effect_speeds(const struct dig_curve_set *const set, const size_t trajectory,
                       double speed[DIG_CURVE_POINTS])
{
    assert(set != NULL && trajectory < set->trajectories && speed != NULL);
    double all_m = 0.0;
    double all_s = 0.0;
    for (size_t t = 0; t < set->trajectories; t++) {
        const double duration_s = dig_trajectory_duration_s(&set->trajectory[t]);
        const int    steps      = (int)(duration_s / step_s);
        all_m += path_m(&set->trajectory[t], set->tooth_m, 0.0, steps);
        all_s += step_s * (double)steps;
    }
    const struct dig_trajectory *const t     = &set->trajectory[trajectory];
    const double                       end_s = dig_trajectory_duration_s(t);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_s =
            dig_trajectory_time_s(t, set->tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
        const double from_s = fmax(at_s - half_s, 0.0);
        const int    steps  = (int)fmax((fmin(at_s + half_s, end_s) - from_s) / step_s, 1.0);
        const double mps    = path_m(t, set->tooth_m, from_s, steps) / ((double)steps * step_s);
        speed[k]            = fmax(mps / (all_m / all_s), least_speed);
    }
}

static double factor(const double value[], const double share, const double speed)
{
    return expm1(value[EXPONENT] * (share + value[ALONG] * log(speed)));
}

const struct dig_effect dig_effect_rate_dependence = {
    .id         = DIG_EFFECT_RATE_DEPENDENCE,
    .summary    = "ground that resists more when dug faster",
    .parameters = PARAMETERS,
    .parameter  = {
        [EXPONENT] = { "exponent", 0.0, -2.0, 2.0, 0.3 },
        [ALONG]    = { "along", 0.0, 0.0, 1.0, 1.0 },
    },
    .by = DIG_BY_PACE,
    .reach = 1.0,
    .factor = factor,
};
