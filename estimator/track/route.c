#include "estimator/track/route.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

struct dig_route dig_route_make(const struct dig_trajectory *const trajectory, const double tooth_m)
{
    assert(trajectory != NULL && trajectory->phases <= DIG_PHASES_MAX);
    struct dig_route route  = { .corners = trajectory->phases + 1 };
    double           time_s = 0.0;
    for (size_t i = 0; i <= trajectory->phases; i++) {
        const struct dig_pose pose = dig_trajectory_pose(trajectory, time_s);
        route.corner[i] = (struct dig_path_point){ pose.x_m, pose.z_m, tooth_m * pose.theta_rad };
        route.at_m[i]   = dig_trajectory_path_m(trajectory, tooth_m, time_s);
        route.at_s[i]   = time_s;
        time_s += i < trajectory->phases ? trajectory->phase[i].duration_s : 0.0;
    }
    return route;
}

struct dig_projection dig_route_project(const struct dig_route *const route, const double dx_m,
                                        const double dz_m, const struct dig_path_point *const point,
                                        const double from, const double to)
{
    assert(route != NULL && point != NULL && route->corners >= 2);
    const double                whole_m = route->at_m[route->corners - 1];
    const double                from_m  = from * whole_m;
    const double                to_m    = to * whole_m;
    const struct dig_path_point at      = { point->x_m - dx_m, point->z_m - dz_m, point->turn_m };

    // Squared distances decide; roots are drawn once, of the nearest.
    struct dig_projection best    = { .distance_m = INFINITY };
    double                best_m2 = INFINITY;
    double                scale   = 0.0; // of the best leg to its unit tangent, 0 at a corner
    for (size_t i = 0; i + 1 < route->corners; i++) {
        const double at_m     = route->at_m[i];
        const double length_m = route->at_m[i + 1] - at_m;
        if (!(length_m > 0.0) || at_m + length_m < from_m || at_m > to_m) {
            continue;
        }
        const struct dig_path_point leg =
            dig_path_point_sub(route->corner[i + 1], route->corner[i]);
        const struct dig_path_point rel    = dig_path_point_sub(at, route->corner[i]);
        const double                leg2   = dig_path_point_dot(leg, leg);
        const double                free_f = dig_path_point_dot(rel, leg) / leg2;
        const double                low_f  = from_m > at_m ? (from_m - at_m) / length_m : 0.0;
        const double high_f  = to_m < at_m + length_m ? (to_m - at_m) / length_m : 1.0;
        const double raised  = free_f > low_f ? free_f : low_f;
        const double f       = raised < high_f ? raised : high_f;
        const bool   is_lead = i == 0 && free_f < 0.0 && low_f <= 0.0;

        // On the lead-in the foot lies before the start, where progress is still 0.
        const struct dig_path_point off =
            dig_path_point_add_scaled(rel, is_lead ? -free_f : -f, leg);
        const double d_m2 = dig_path_point_dot(off, off);
        if (d_m2 < best_m2) {
            best_m2       = d_m2;
            best.progress = (at_m + f * length_m) / whole_m;
            best.tangent  = leg;
            best.off      = off;
            scale         = is_lead || (free_f > 0.0 && free_f < 1.0) ? 1.0 / sqrt(leg2) : 0.0;
        }
    }
    best.distance_m = sqrt(best_m2);
    best.tangent.x_m *= scale;
    best.tangent.z_m *= scale;
    best.tangent.turn_m *= scale;
    return best;
}

// A leg, and the share of it.
struct place {
    size_t leg;
    double share;
};

static struct place place_of(const struct dig_route *const route, const double progress)
{
    assert(route != NULL && route->corners >= 2);
    const double at_m = progress * route->at_m[route->corners - 1];
    size_t       i    = 0;
    while (i + 2 < route->corners && route->at_m[i + 1] <= at_m) {
        i++;
    }
    const double length_m = route->at_m[i + 1] - route->at_m[i];
    return (struct place){ i, length_m > 0.0 ? (at_m - route->at_m[i]) / length_m : 0.0 };
}

struct dig_path_point dig_route_point(const struct dig_route *const route, const double progress)
{
    const struct place          at = place_of(route, progress);
    const struct dig_path_point leg =
        dig_path_point_sub(route->corner[at.leg + 1], route->corner[at.leg]);
    return dig_path_point_add_scaled(route->corner[at.leg], at.share, leg);
}

double dig_route_time_s(const struct dig_route *const route, const double progress)
{
    const struct place at = place_of(route, progress);
    return route->at_s[at.leg] + at.share * (route->at_s[at.leg + 1] - route->at_s[at.leg]);
}
