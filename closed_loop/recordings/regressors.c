#include "closed_loop/recordings/regressors.h"

#include <assert.h>
#include <math.h>

const char *dig_regressors_name(const enum dig_regressors state)
{
    static const char *const name[DIG_REGRESSORS] = {
        "path", "depth_m", "speed_mps", "acceleration_mps2", "fill_m2", "pass",
    };
    assert((size_t)state < DIG_REGRESSORS);
    return name[state];
}

struct place {
    double x_m, z_m;
};

static struct place tooth_at(const struct dig_curve_set *const  set,
                             const struct dig_trajectory *const t, const double time_s)
{
    const struct dig_pose pose = dig_trajectory_pose(t, time_s);
    return (struct place){ pose.x_m + set->tooth_m * sin(pose.theta_rad),
                           pose.z_m - set->tooth_m * cos(pose.theta_rad) };
}

void dig_regressors_along(const struct dig_curve_set *const set,
                          const struct dig_measured *const  dig,
                          double                            state[DIG_REGRESSORS][DIG_CURVE_POINTS])
{
    assert(set != NULL && dig != NULL && (size_t)dig->trajectory < set->trajectories);
    const struct dig_trajectory *const t      = &set->trajectory[dig->trajectory];
    const double                       end_s  = dig_trajectory_duration_s(t);
    const double                       half_s = fmin(DIG_SMOOTH_HALF_s, end_s / 4.0);
    const struct place                 start  = tooth_at(set, t, 0.0);
    struct place                       before = start;
    double                             fill   = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double       progress = (double)k / (DIG_CURVE_POINTS - 1);
        const double       time_s   = dig_trajectory_time_s(t, set->tooth_m, progress);
        const double       mid_s    = fmin(fmax(time_s, half_s), end_s - half_s);
        const struct place here     = tooth_at(set, t, time_s);
        const struct place mid      = tooth_at(set, t, mid_s);
        const struct place from     = tooth_at(set, t, mid_s - half_s);
        const struct place to       = tooth_at(set, t, mid_s + half_s);
        const double       depth_m  = fmax(start.z_m - here.z_m, 0.0);
        fill += 0.5 * (depth_m + fmax(start.z_m - before.z_m, 0.0)) * fabs(here.x_m - before.x_m);
        before = here;

        state[DIG_REGRESSOR_PATH][k] = progress;
        state[DIG_STATE_DEPTH_m][k]  = depth_m;
        state[DIG_STATE_SPEED_mps][k] =
            dig->pace * hypot(to.x_m - from.x_m, to.z_m - from.z_m) / (2.0 * half_s);
        state[DIG_STATE_ACCELERATION_mps2][k] =
            dig->pace * dig->pace *
            hypot(to.x_m - 2.0 * mid.x_m + from.x_m, to.z_m - 2.0 * mid.z_m + from.z_m) /
            (half_s * half_s);
        state[DIG_STATE_FILL_m2][k]  = fill;
        state[DIG_REGRESSOR_PASS][k] = (double)dig->pass;
    }
}

bool dig_regressors_is_lifted(const struct dig_curve_set *const set, const size_t trajectory,
                              const double progress)
{
    const struct dig_trajectory *const t = &set->trajectory[trajectory];
    const size_t phase = dig_trajectory_phase(t, dig_trajectory_time_s(t, set->tooth_m, progress));
    return phase + 1 == t->phases && t->phase[phase].vz_mps > 0.0;
}
