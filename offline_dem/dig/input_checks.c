#include "offline_dem/dig/input_checks.h"

#include "offline_dem/kernel/neighbour.h"
#include "offline_dem/law/period.h"
#include "offline_dem/shapes/bucket_surface.h"

#include <math.h>
#include <stdlib.h>

#define PATH_STEPS     500 // poses along a trajectory
#define OVERLAP_MOST   0.3 // of the smaller radius: ten times that of a bed of soft grains at rest
#define CUT_MOST       0.5 // radii a plate may cut into a grain at the start: levelled beds rise a little
#define OVERLAP_MARGIN 0.01 // of a radius: margin of the neighbour list of this check

// Largest distance of the bucket beyond the box in this pose, and its coordinate.
static double outside_m(const struct dig_scene *const scene, const struct dig_pose pose,
                        const char **const axis)
{
    const struct dig_box *const    box    = &scene->box;
    const struct dig_bucket *const bucket = &scene->bucket;
    const double                   c      = cos(pose.theta_rad);
    const double                   s      = sin(pose.theta_rad);
    const double                   half_m = 0.5 * bucket->width_m;
    double                         most_m = fmax(box->y_min_m + half_m, half_m - box->y_max_m);
    *axis                                 = "y";
    for (size_t k = 0; k < bucket->points; k++) {
        const double x_m  = pose.x_m + c * bucket->x_m[k] - s * bucket->z_m[k];
        const double z_m  = pose.z_m + s * bucket->x_m[k] + c * bucket->z_m[k];
        const double by_x = fmax(box->x_min_m - x_m, x_m - box->x_max_m);
        if (by_x > most_m) {
            most_m = by_x;
            *axis  = "x";
        }
        if (box->z_min_m - z_m > most_m) {
            most_m = box->z_min_m - z_m;
            *axis  = "z";
        }
    }
    return most_m;
}

enum dig_status dig_input_checks_path(const struct dig_scene *const      scene,
                                      const struct dig_trajectory *const trajectory,
                                      struct dig_error *const            error)
{
    const double duration_s = dig_trajectory_duration_s(trajectory);
    for (int i = 0; i <= PATH_STEPS; i++) {
        const double t_s   = duration_s * i / PATH_STEPS;
        const char  *axis  = "";
        const double out_m = outside_m(scene, dig_trajectory_pose(trajectory, t_s), &axis);
        if (out_m > 0.0) {
            return dig_error_set(error, DIG_EINVAL,
                                 "trajectory %s: at %.3g s the bucket is %.3g m outside box_m.%s, "
                                 "expected a path between the walls and above the floor",
                                 trajectory->name, t_s, out_m, axis);
        }
    }
    return DIG_OK;
}

static enum dig_status find_overlap(const struct dig_world *const      world,
                                    const struct dig_neighbours *const near,
                                    struct dig_error *const            error)
{
    const struct dig_grains *const g              = &world->grains;
    const double                   inverse_period = dig_period_inverse(world->period_y_m);
    for (uint32_t i = 0; i < g->n; i++) {
        for (uint32_t s = near->start[i]; s < near->start[i + 1]; s++) {
            const uint32_t      j    = near->other[s];
            const double *const x    = g->motion[i].x_m;
            const double *const y    = g->motion[j].x_m;
            const double        ri_m = g->type[g->type_of[i]].radius_m;
            const double        rj_m = g->type[g->type_of[j]].radius_m;
            const double dy_m = dig_period_fold(x[1] - y[1], world->period_y_m, inverse_period);
            const double d_m  = hypot(hypot(x[0] - y[0], dy_m), x[2] - y[2]);
            const double deep = (ri_m + rj_m - d_m) / fmin(ri_m, rj_m);
            if (deep > OVERLAP_MOST) {
                return dig_error_set(error, DIG_EINVAL,
                                     "bed: grains %u and %u overlap by %.2g of the smaller's "
                                     "radius, expected at most %g",
                                     (unsigned)g->id[i], (unsigned)g->id[j], deep, OVERLAP_MOST);
            }
        }
    }
    return DIG_OK;
}

enum dig_status dig_input_checks_overlap(const struct dig_world *const world,
                                         struct dig_error *const       error)
{
    const struct dig_grains *const g      = &world->grains;
    struct dig_neighbours          near   = { 0 };
    double *const                  margin = malloc((g->n + 1) * sizeof *margin);
    enum dig_status                status = DIG_ENOMEM;
    for (size_t i = 0; margin != NULL && i < g->n; i++) {
        margin[i] = OVERLAP_MARGIN * g->type[g->type_of[i]].radius_m;
    }
    if (margin != NULL) {
        status = dig_neighbours_build(g, world->period_y_m, margin, NULL, &near);
    }
    status = status == DIG_OK ? find_overlap(world, &near, error)
                              : dig_error_set(error, status, "%s", dig_status_str(status));
    dig_neighbours_finish(&near);
    free(margin);
    return status;
}

enum dig_status dig_input_checks_outside(const struct dig_world *const world,
                                         struct dig_error *const       error)
{
    const struct dig_grains *const g = &world->grains;
    for (size_t i = 0; i < g->n; i++) {
        const double *const x        = g->motion[i].x_m;
        const double        radius_m = g->type[g->type_of[i]].radius_m;
        for (size_t w = 0; w < world->walls; w++) {
            const double *const n      = world->wall[w].normal;
            const double        d_m    = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
            const double        deep_m = world->wall[w].offset_m + radius_m - d_m;
            if (deep_m > OVERLAP_MOST * radius_m) {
                return dig_error_set(error, DIG_EINVAL,
                                     "bed: grain %u at (%.4g, %.4g, %.4g) m is %.3g m behind a "
                                     "wall of box_m, expected at most %g of its radius",
                                     (unsigned)g->id[i], x[0], x[1], x[2], deep_m, OVERLAP_MOST);
            }
        }
    }
    return DIG_OK;
}

enum dig_status dig_input_checks_start(const struct dig_world *const world,
                                       const struct dig_tool *const  tool,
                                       struct dig_error *const       error)
{
    for (size_t i = 0; i < world->grains.n; i++) {
        const double *const x        = world->grains.motion[i].x_m;
        const double        radius_m = world->grains.type[world->grains.type_of[i]].radius_m;
        double              body_m[3];
        bool                inside = dig_tool_contains(tool, x);
        dig_tool_to_body(tool, x, body_m);
        for (size_t p = 0; p < tool->plates && !inside; p++) {
            double c[3];
            dig_bucket_closest(&tool->bucket, p, body_m, c);
            const double d_m = hypot(hypot(body_m[0] - c[0], body_m[1] - c[1]), body_m[2] - c[2]);
            inside           = d_m < (1.0 - CUT_MOST) * radius_m;
        }
        if (inside) {
            return dig_error_set(error, DIG_EINVAL,
                                 "start_pin_m: the bucket starts in the bed, at the grain at "
                                 "(%.4g, %.4g, %.4g) m, expected it clear of all grains",
                                 x[0], x[1], x[2]);
        }
    }
    return DIG_OK;
}
