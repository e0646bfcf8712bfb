// Closest points on the bucket's plates, in body coordinates. Inlined into tool.c and into the
// device's step (offline_dem/world/device.h).

#ifndef DIG_OFFLINE_DEM_SHAPES_BUCKET_SURFACE_H
#define DIG_OFFLINE_DEM_SHAPES_BUCKET_SURFACE_H

#include "core/scene.h"
#include "offline_dem/law/both.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

DIG_BOTH static inline double dig_clamp(const double x, const double low, const double high)
{
    return x < low ? low : x > high ? high : x;
}

DIG_BOTH static inline double dig_bucket_distance(const double a[3], const double b[3])
{
    const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

// The closest point of the profile's segment a-b, in the plane.
DIG_BOTH static inline void dig_bucket_closest_on_segment(const struct dig_bucket *const bucket,
                                                          const size_t a, const size_t b,
                                                          const double x, const double z,
                                                          double *const cx, double *const cz)
{
    const double ux = bucket->x_m[b] - bucket->x_m[a];
    const double uz = bucket->z_m[b] - bucket->z_m[a];
    const double s  = dig_clamp(
         ((x - bucket->x_m[a]) * ux + (z - bucket->z_m[a]) * uz) / (ux * ux + uz * uz), 0.0, 1.0);
    *cx = bucket->x_m[a] + s * ux;
    *cz = bucket->z_m[a] + s * uz;
}

// Even-odd rule, so that a profile need not be convex.
DIG_BOTH static inline bool dig_bucket_is_inside(const struct dig_bucket *const bucket,
                                                 const double x, const double z)
{
    bool inside = false;
    for (size_t a = 0, b = bucket->points - 1; a < bucket->points; b = a++) {
        const double za = bucket->z_m[a];
        const double zb = bucket->z_m[b];
        if ((za > z) != (zb > z) &&
            x < bucket->x_m[a] + (z - za) / (zb - za) * (bucket->x_m[b] - bucket->x_m[a])) {
            inside = !inside;
        }
    }
    return inside;
}

DIG_BOTH static inline void dig_bucket_closest_on_polygon(const struct dig_bucket *const bucket,
                                                          const double x, const double z,
                                                          double *const cx, double *const cz)
{
    *cx = x;
    *cz = z;
    if (dig_bucket_is_inside(bucket, x, z)) {
        return;
    }
    double best_m2 = INFINITY;
    for (size_t a = 0, b = bucket->points - 1; a < bucket->points; b = a++) {
        double ex;
        double ez;
        dig_bucket_closest_on_segment(bucket, b, a, x, z, &ex, &ez);
        const double m2 = (x - ex) * (x - ex) + (z - ez) * (z - ez);
        if (m2 < best_m2) {
            best_m2 = m2;
            *cx     = ex;
            *cz     = ez;
        }
    }
}

/// The point of the plate (tool.h) closest to body_m: on its face, an edge or a vertex. A point in
/// the plate is its own closest point.
DIG_BOTH static inline void dig_bucket_closest(const struct dig_bucket *const bucket,
                                               const size_t plate, const double body_m[3],
                                               double closest_m[3])
{
    const double half_m = 0.5 * bucket->width_m;
    if (plate + 1 < bucket->points) {
        dig_bucket_closest_on_segment(bucket, plate, plate + 1, body_m[0], body_m[2], &closest_m[0],
                                      &closest_m[2]);
        closest_m[1] = dig_clamp(body_m[1], -half_m, half_m);
    } else {
        dig_bucket_closest_on_polygon(bucket, body_m[0], body_m[2], &closest_m[0], &closest_m[2]);
        closest_m[1] = plate + 1 == bucket->points ? -half_m : half_m;
    }
}

#endif // DIG_OFFLINE_DEM_SHAPES_BUCKET_SURFACE_H
