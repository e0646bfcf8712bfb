// A trajectory as a route through (x, z, turn), and the projection of a pose on it.
//
// A pose is a point (x, z, turn) with turn = tooth_m * theta, in rig scale; a trajectory of
// constant rates is a polyline there. Progress is the share of the path length, |pin| + tooth
// |turn|, not of time.

#ifndef DIG_ESTIMATOR_TRACK_ROUTE_H
#define DIG_ESTIMATOR_TRACK_ROUTE_H

#include "core/curve.h"

#include <stddef.h>

struct dig_path_point {
    double x_m, z_m, turn_m;
};

static inline struct dig_path_point dig_path_point_sub(const struct dig_path_point a,
                                                       const struct dig_path_point b)
{
    return (struct dig_path_point){ a.x_m - b.x_m, a.z_m - b.z_m, a.turn_m - b.turn_m };
}

/// a + s * b
static inline struct dig_path_point dig_path_point_add_scaled(const struct dig_path_point a,
                                                              const double                s,
                                                              const struct dig_path_point b)
{
    return (struct dig_path_point){ a.x_m + s * b.x_m, a.z_m + s * b.z_m, a.turn_m + s * b.turn_m };
}

static inline double dig_path_point_dot(const struct dig_path_point a,
                                        const struct dig_path_point b)
{
    return a.x_m * b.x_m + a.z_m * b.z_m + a.turn_m * b.turn_m;
}

/// A polyline, and the range of a constant turn of the bucket along it: 0 and 0 by default.
struct dig_route {
    size_t                corners;
    struct dig_path_point corner[DIG_PHASES_MAX + 1];
    double                at_m[DIG_PHASES_MAX + 1]; // path length up to each corner
    double                at_s[DIG_PHASES_MAX + 1]; // when the trajectory is there
    double                turn_least_m, turn_most_m;
};

struct dig_route dig_route_make(const struct dig_trajectory *trajectory, double tooth_m);

/// The projection of a point on a route shifted by (dx, dz).
struct dig_projection {
    double progress;   // 0 … 1
    double distance_m; // in (x, z, turn)
    // Unit tangent, or 0 at a corner, and the vector from route to point.
    struct dig_path_point tangent, off;
};

/// The point of the route at a progress, and when the trajectory is there. O(corners).
struct dig_path_point dig_route_point(const struct dig_route *route, double progress);
double                dig_route_time_s(const struct dig_route *route, double progress);

/// Projects a point on the route between progress from and to. The first leg is extended backwards
/// beyond the start (progress stays 0): approaching along it is no distance. O(corners).
struct dig_projection dig_route_project(const struct dig_route *route, double dx_m, double dz_m,
                                        const struct dig_path_point *point, double from, double to);

#endif // DIG_ESTIMATOR_TRACK_ROUTE_H
