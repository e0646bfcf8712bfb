#include "estimator/approach/approach_fit.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

enum { POINTS = DIG_APPROACH_FIT_POINTS, RESIDUALS = 3 * POINTS, STEPS = 12 };

// Steps of the derivatives, and the least change that is worth another step.
static const double step[2]  = { 1e-4, 1e-4 };
static const double settled  = 1e-9;
static const double farthest = 0.2; // of depth or attack, in one step

// Path minus trajectory, without the mean shift of the pin.
static void residuals(const struct dig_trajectory *const trajectory, const double tooth_m,
                      const struct dig_path_point path[const POINTS], double off[const RESIDUALS])
{
    double mean_x_m = 0.0;
    double mean_z_m = 0.0;
    for (size_t k = 0; k < POINTS; k++) {
        const double          progress = (double)k / (POINTS - 1);
        const struct dig_pose pose =
            dig_trajectory_pose(trajectory, dig_trajectory_time_s(trajectory, tooth_m, progress));
        off[3 * k]     = path[k].x_m - pose.x_m;
        off[3 * k + 1] = path[k].z_m - pose.z_m;
        off[3 * k + 2] = path[k].turn_m - tooth_m * pose.theta_rad;
        mean_x_m += off[3 * k] / POINTS;
        mean_z_m += off[3 * k + 1] / POINTS;
    }
    for (size_t k = 0; k < POINTS; k++) {
        off[3 * k] -= mean_x_m;
        off[3 * k + 1] -= mean_z_m;
    }
}

static double rms(const double off[const RESIDUALS])
{
    double sum = 0.0;
    for (size_t i = 0; i < RESIDUALS; i++) {
        sum += off[i] * off[i];
    }
    return sqrt(sum / POINTS);
}

struct fit {
    const struct dig_trajectory *trajectory;
    double                       tooth_m, depth_m;
    const struct dig_path_point *path;
};

// False where the trajectory cannot be dug so.
static bool try_at(const struct fit *const fit, const double at[const 2],
                   double off[const RESIDUALS])
{
    const struct dig_approach approach = { at[0], at[1] };
    struct dig_trajectory     dug;
    if (dig_approach_apply(fit->trajectory, fit->tooth_m, fit->depth_m, &approach, &dug, NULL) !=
        DIG_OK) {
        return false;
    }
    residuals(&dug, fit->tooth_m, fit->path, off);
    return true;
}

// One step of Gauss and Newton from `at`; false when there is none.
static bool move(const struct fit *const fit, const bool deepens, const double off[const RESIDUALS],
                 const double at[const 2], double by[const 2])
{
    double slope[2][RESIDUALS] = { { 0.0 } };
    double a[2][2]             = { { deepens ? 0.0 : 1.0, 0.0 }, { 0.0, 0.0 } };
    double b[2]                = { 0.0, 0.0 };
    for (size_t p = deepens ? 0 : 1; p < 2; p++) {
        double there[2] = { at[0], at[1] };
        there[p] += step[p];
        if (!try_at(fit, there, slope[p])) {
            return false;
        }
        for (size_t i = 0; i < RESIDUALS; i++) {
            slope[p][i] = (slope[p][i] - off[i]) / step[p];
        }
    }
    for (size_t i = 0; i < RESIDUALS; i++) {
        for (size_t p = 0; p < 2; p++) {
            b[p] -= slope[p][i] * off[i];
            a[p][0] += slope[p][i] * slope[0][i];
            a[p][1] += slope[p][i] * slope[1][i];
        }
    }
    const double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    if (!(fabs(det) > 0.0)) {
        return false;
    }
    by[0] = (a[1][1] * b[0] - a[0][1] * b[1]) / det;
    by[1] = (a[0][0] * b[1] - a[1][0] * b[0]) / det;
    for (size_t p = 0; p < 2; p++) {
        by[p] = fmin(fmax(by[p], -farthest), farthest);
    }
    return true;
}

double dig_approach_fit(const struct dig_trajectory *const trajectory, const double tooth_m,
                        const double depth_m, const struct dig_path_point path[const POINTS],
                        struct dig_approach *const approach)
{
    assert(trajectory != NULL && path != NULL && approach != NULL && tooth_m > 0.0);
    const struct fit fit     = { trajectory, tooth_m, depth_m, path };
    const bool       deepens = depth_m > 0.0 && trajectory->phase[0].vz_mps < 0.0;
    double           at[2]   = { 1.0, 0.0 };
    double           off[RESIDUALS];
    residuals(trajectory, tooth_m, path, off);
    double least = rms(off);
    for (int i = 0; i < STEPS; i++) {
        double by[2];
        if (!move(&fit, deepens, off, at, by) || hypot(by[0], by[1]) < settled) {
            break;
        }
        const double there[2] = { at[0] + by[0], at[1] + by[1] };
        double       next[RESIDUALS];
        if (!try_at(&fit, there, next) || !(rms(next) < least)) {
            break;
        }
        least = rms(next);
        at[0] = there[0];
        at[1] = there[1];
        for (size_t k = 0; k < RESIDUALS; k++) {
            off[k] = next[k];
        }
    }
    *approach = (struct dig_approach){ at[0], at[1] };
    return least;
}
