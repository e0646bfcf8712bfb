#include "offline_dem/tool.h"

#include <math.h>

struct dig_tool dig_tool_make(const struct dig_bucket *const bucket)
{
    struct dig_tool tool = { .bucket = *bucket, .plates = bucket->points + 1, .cosine = 1.0 };
    for (size_t k = 0; k < bucket->points; k++) {
        tool.radius_m = fmax(tool.radius_m, hypot(bucket->x_m[k], bucket->z_m[k]));
    }
    return tool;
}

void dig_tool_place(struct dig_tool *const tool, const struct dig_pose pose, const double vx_mps,
                    const double vz_mps, const double w_radps)
{
    tool->pose    = pose;
    tool->cosine  = cos(pose.theta_rad);
    tool->sine    = sin(pose.theta_rad);
    tool->vx_mps  = vx_mps;
    tool->vz_mps  = vz_mps;
    tool->w_radps = w_radps;
}

void dig_tool_to_body(const struct dig_tool *const tool, const double world_m[], double body_m[3])
{
    const double x = world_m[0] - tool->pose.x_m;
    const double z = world_m[2] - tool->pose.z_m;
    body_m[0]      = tool->cosine * x + tool->sine * z;
    body_m[1]      = world_m[1];
    body_m[2]      = -tool->sine * x + tool->cosine * z;
}

void dig_tool_turn(const struct dig_tool *const tool, const double body[3], double world[3])
{
    const double x = tool->cosine * body[0] - tool->sine * body[2];
    const double z = tool->sine * body[0] + tool->cosine * body[2];
    world[0]       = x;
    world[1]       = body[1];
    world[2]       = z;
}

static double clamp(const double x, const double low, const double high)
{
    return x < low ? low : x > high ? high : x;
}

// The closest point of the profile's segment a-b, in the plane.
static void closest_on_segment(const struct dig_bucket *const bucket, const size_t a,
                               const size_t b, const double x, const double z, double *const cx,
                               double *const cz)
{
    const double ux = bucket->x_m[b] - bucket->x_m[a];
    const double uz = bucket->z_m[b] - bucket->z_m[a];
    const double s  = clamp(
         ((x - bucket->x_m[a]) * ux + (z - bucket->z_m[a]) * uz) / (ux * ux + uz * uz), 0.0, 1.0);
    *cx = bucket->x_m[a] + s * ux;
    *cz = bucket->z_m[a] + s * uz;
}

// Even-odd rule, so that a profile need not be convex.
static bool is_inside(const struct dig_bucket *const bucket, const double x, const double z)
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

static void closest_on_polygon(const struct dig_bucket *const bucket, const double x,
                               const double z, double *const cx, double *const cz)
{
    if (is_inside(bucket, x, z)) {
        *cx = x;
        *cz = z;
        return;
    }
    double best_m2 = INFINITY;
    for (size_t a = 0, b = bucket->points - 1; a < bucket->points; b = a++) {
        double ex;
        double ez;
        closest_on_segment(bucket, b, a, x, z, &ex, &ez);
        const double m2 = (x - ex) * (x - ex) + (z - ez) * (z - ez);
        if (m2 < best_m2) {
            best_m2 = m2;
            *cx     = ex;
            *cz     = ez;
        }
    }
}

void dig_tool_closest(const struct dig_tool *const tool, const size_t plate, const double body_m[3],
                      double closest_m[3])
{
    const struct dig_bucket *const bucket = &tool->bucket;
    const double                   half_m = 0.5 * bucket->width_m;
    if (plate + 1 < bucket->points) {
        closest_on_segment(bucket, plate, plate + 1, body_m[0], body_m[2], &closest_m[0],
                           &closest_m[2]);
        closest_m[1] = clamp(body_m[1], -half_m, half_m);
    } else {
        closest_on_polygon(bucket, body_m[0], body_m[2], &closest_m[0], &closest_m[2]);
        closest_m[1] = plate + 1 == bucket->points ? -half_m : half_m;
    }
}

bool dig_tool_holds(const struct dig_tool *const tool, const double world_m[const 3])
{
    double body_m[3];
    dig_tool_to_body(tool, world_m, body_m);
    return fabs(body_m[1]) <= 0.5 * tool->bucket.width_m &&
           is_inside(&tool->bucket, body_m[0], body_m[2]);
}

double dig_tool_travel_m(const struct dig_tool *const tool, const struct dig_pose from,
                         const struct dig_pose to)
{
    return hypot(to.x_m - from.x_m, to.z_m - from.z_m) +
           tool->radius_m * fabs(to.theta_rad - from.theta_rad);
}
