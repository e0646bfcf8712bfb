// The bucket as a surface for contacts: plates of zero thickness on the trajectory.
//
// Plates 0 … points - 2 stand on the profile's polyline, across the width; the last two are the
// sides, the profile's polygon at y = -width/2 and +width/2. Grains touch them from both sides.
// Body and world frame, signs: core/curve.h; the body's (x, z) is rotated by theta about the pin.

#ifndef DIG_OFFLINE_DEM_SHAPES_TOOL_H
#define DIG_OFFLINE_DEM_SHAPES_TOOL_H

#include "core/curve.h"
#include "core/scene.h"
#include "offline_dem/law/both.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_PLATES_MAX (DIG_PROFILE_MAX + 1)

struct dig_tool {
    struct dig_bucket bucket;
    size_t            plates;
    struct dig_pose   pose;
    double            cosine, sine;            // of theta
    double            vx_mps, vz_mps, w_radps; // of the pin, and of theta
    double            radius_m;                // farthest point from the pin, in the plane
};

/// Force and moment of the grains on the tool, summed over steps.
struct dig_wrench {
    double f_N[3];
    double t_Nm[3]; // about the moving pin
};

static inline void dig_wrench_add(const struct dig_wrench *const wrench,
                                  struct dig_wrench *const       sum)
{
    for (int k = 0; k < 3; k++) {
        sum->f_N[k] += wrench->f_N[k];
        sum->t_Nm[k] += wrench->t_Nm[k];
    }
}

/// Adds the reaction of a contact to the body that is not the grain: of f_N on the grain, and its
/// own torque t_Nm. arm_m: from where torques are about to the contact.
DIG_BOTH static inline void dig_wrench_react(const double f_N[3], const double t_Nm[3],
                                             const double arm_m[3], struct dig_wrench *const sum)
{
    for (int k = 0; k < 3; k++) {
        const int next  = (k + 1) % 3;
        const int other = (k + 2) % 3;
        sum->f_N[k] -= f_N[k];
        sum->t_Nm[k] += t_Nm[k] - (arm_m[next] * f_N[other] - arm_m[other] * f_N[next]);
    }
}

struct dig_tool dig_tool_make(const struct dig_bucket *bucket);

/// Sets the tool's pose and velocity.
void dig_tool_place(struct dig_tool *tool, struct dig_pose pose, double vx_mps, double vz_mps,
                    double w_radps);

/// World to body coordinates.
DIG_BOTH static inline void dig_tool_to_body(const struct dig_tool *const tool,
                                             const double world_m[], double body_m[3])
{
    const double x = world_m[0] - tool->pose.x_m;
    const double z = world_m[2] - tool->pose.z_m;
    body_m[0]      = tool->cosine * x + tool->sine * z;
    body_m[1]      = world_m[1];
    body_m[2]      = -tool->sine * x + tool->cosine * z;
}

/// Rotates a direction, body to world.
DIG_BOTH static inline void dig_tool_rotate(const struct dig_tool *const tool, const double body[3],
                                            double world[3])
{
    const double x = tool->cosine * body[0] - tool->sine * body[2];
    const double z = tool->sine * body[0] + tool->cosine * body[2];
    world[0]       = x;
    world[1]       = body[1];
    world[2]       = z;
}

/// Of a point and the tool's closest to it, in body coordinates: their distance d_m, the arm from
/// the pin to the closest point and its velocity, in the world's.
DIG_BOTH static inline void dig_tool_separation(const struct dig_tool *const tool,
                                                const double body_m[3], const double closest_m[3],
                                                double d_m[3], double arm_m[3], double v_mps[3])
{
    const double away_m[3] = { body_m[0] - closest_m[0], body_m[1] - closest_m[1],
                               body_m[2] - closest_m[2] };
    dig_tool_rotate(tool, away_m, d_m);
    dig_tool_rotate(tool, closest_m, arm_m);
    v_mps[0] = tool->vx_mps - tool->w_radps * arm_m[2];
    v_mps[1] = 0.0;
    v_mps[2] = tool->vz_mps + tool->w_radps * arm_m[0];
}

/// True where a point of the world lies inside the profile's closed polygon and the width: carried.
bool dig_tool_contains(const struct dig_tool *tool, const double world_m[3]);

/// Upper bound of the distance any point of the tool moves between two poses.
double dig_tool_travel_m(const struct dig_tool *tool, struct dig_pose from, struct dig_pose to);

#endif // DIG_OFFLINE_DEM_SHAPES_TOOL_H
