// Closest points on a rock's surface. Inlined into obstacles.c and into the device's step
// (offline_dem/world/device.h).

#ifndef DIG_OFFLINE_DEM_SHAPES_ROCK_SURFACE_H
#define DIG_OFFLINE_DEM_SHAPES_ROCK_SURFACE_H

#include "core/scene.h"
#include "offline_dem/law/both.h"
#include "offline_dem/law/rigid.h"

#include <math.h>

/// A rock's shape, size and pose.
struct dig_rock_surface {
    enum dig_obstacle_shape shape;
    double                  half_m[3]; // sphere: its radius in half_m[0]; box: half its edges
    double                  x_m[3], q[4];
};

/// The point of a box's faces closest to a point inside it.
DIG_BOTH static inline double dig_rock_surface_face(const double half_m[3], const double p[3],
                                                    double closest_m[3])
{
    int    axis    = 0;
    double least_m = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (half_m[k] - fabs(p[k]) < least_m) {
            least_m = half_m[k] - fabs(p[k]);
            axis    = k;
        }
    }
    for (int k = 0; k < 3; k++) {
        closest_m[k] = k == axis ? copysign(half_m[k], p[k]) : p[k];
    }
    return -least_m;
}

/// The point of the rock's surface closest to p_m, and the distance to it: negative inside.
DIG_BOTH static inline double dig_rock_surface_closest(const struct dig_rock_surface *const rock,
                                                       const double p_m[3], double closest_m[3])
{
    const double d[3]  = { p_m[0] - rock->x_m[0], p_m[1] - rock->x_m[1], p_m[2] - rock->x_m[2] };
    double       apart = 0.0;
    if (rock->shape == DIG_OBSTACLE_SPHERE) {
        const double d_m = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + 1e-300;
        for (int k = 0; k < 3; k++) {
            closest_m[k] = rock->x_m[k] + d[k] / d_m * rock->half_m[0];
        }
        return d_m - rock->half_m[0];
    }
    double p[3];
    double c[3];
    dig_rigid_rotate_back(rock->q, d, p);
    for (int k = 0; k < 3; k++) {
        c[k] = fmin(fmax(p[k], -rock->half_m[k]), rock->half_m[k]);
        apart += (p[k] - c[k]) * (p[k] - c[k]);
    }
    apart = apart > 0.0 ? sqrt(apart) : dig_rock_surface_face(rock->half_m, p, c);
    dig_rigid_rotate(rock->q, c, closest_m);
    for (int k = 0; k < 3; k++) {
        closest_m[k] += rock->x_m[k];
    }
    return apart;
}

/// Separation of the rock's surface and a point at p_m for the contact law. A grain pressed into a
/// rock stays outside of it, by a thousandth of its radius.
DIG_BOTH static inline void dig_rock_surface_separation(const struct dig_rock_surface *const rock,
                                                        const double p_m[3], const double radius_m,
                                                        double closest_m[3], double d_m[3])
{
    const double apart_m = dig_rock_surface_closest(rock, p_m, closest_m);
    const double safe_m  = fmax(apart_m, 1e-3 * radius_m);
    double       n[3];
    double       length_m = 0.0;
    for (int k = 0; k < 3; k++) {
        n[k] = (p_m[k] - closest_m[k]) * (apart_m < 0.0 ? -1.0 : 1.0);
        length_m += n[k] * n[k];
    }
    length_m = sqrt(length_m) + 1e-300;
    for (int k = 0; k < 3; k++) {
        d_m[k] = safe_m * n[k] / length_m;
    }
}

#endif // DIG_OFFLINE_DEM_SHAPES_ROCK_SURFACE_H
