#include "offline_dem/shapes/tool.h"

#include "offline_dem/shapes/bucket_surface.h"

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

bool dig_tool_contains(const struct dig_tool *const tool, const double world_m[const 3])
{
    double body_m[3];
    dig_tool_to_body(tool, world_m, body_m);
    return fabs(body_m[1]) <= 0.5 * tool->bucket.width_m &&
           dig_bucket_is_inside(&tool->bucket, body_m[0], body_m[2]);
}

double dig_tool_travel_m(const struct dig_tool *const tool, const struct dig_pose from,
                         const struct dig_pose to)
{
    return hypot(to.x_m - from.x_m, to.z_m - from.z_m) +
           tool->radius_m * fabs(to.theta_rad - from.theta_rad);
}
