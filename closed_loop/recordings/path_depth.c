#include "closed_loop/recordings/path_depth.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Points behind the first leg whose mean is its end.
static const size_t behind = DIG_CURVE_POINTS / 20;

static double tooth_z_m(const double pin_z_m, const double theta_rad, const double tooth_m)
{
    return pin_z_m - tooth_m * cos(theta_rad);
}

void dig_path_depth_add(struct dig_path_depth *const depth, const struct dig_route *const route,
                        const double tooth_m, const double attack_rad, const double progress,
                        const struct dig_path_point *const pose)
{
    assert(depth != NULL && route != NULL && pose != NULL && progress >= 0.0 && progress <= 1.0);
    const size_t                k    = (size_t)lround(progress * (DIG_CURVE_POINTS - 1));
    const struct dig_path_point made = dig_route_point(route, progress);
    depth->deeper_m[k] += tooth_z_m(made.z_m, made.turn_m / tooth_m + attack_rad, tooth_m) -
                          tooth_z_m(pose->z_m, pose->turn_m / tooth_m, tooth_m);
    depth->poses[k]++;
}

void dig_path_depth_tell(const struct dig_path_depth *const depth,
                         const struct dig_route *const route, const double depth_m,
                         double deeper[const DIG_CURVE_POINTS])
{
    assert(depth != NULL && route != NULL && depth_m > 0.0 && deeper != NULL);
    const double first_leg = route->at_m[1] / route->at_m[route->corners - 1];
    const size_t leg_end   = (size_t)(first_leg * (DIG_CURVE_POINTS - 1));
    double       sum_m     = 0.0;
    double       poses     = 0.0;
    for (size_t k = leg_end; k < DIG_CURVE_POINTS && k <= leg_end + behind; k++) {
        sum_m += depth->deeper_m[k];
        poses += (double)depth->poses[k];
    }
    memset(deeper, 0, DIG_CURVE_POINTS * sizeof deeper[0]);
    if (!(poses > 0.0)) {
        return;
    }
    size_t told = leg_end; // the last point with a pose
    for (size_t k = leg_end + 1; k < DIG_CURVE_POINTS; k++) {
        deeper[k] = deeper[told];
        if (depth->poses[k] == 0) {
            continue;
        }
        deeper[k] = (depth->deeper_m[k] / (double)depth->poses[k] - sum_m / poses) / depth_m;
        for (size_t i = told + 1; i < k; i++) {
            deeper[i] =
                deeper[told] + (deeper[k] - deeper[told]) * (double)(i - told) / (double)(k - told);
        }
        told = k;
    }
}
