#include "core/approach.h"

#include "core/ground.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

// Grain diameters a turned bucket's heel may be in the ground at the start.
static const double heel_in_grains = 0.5;

struct dig_approach dig_approach_plain(void)
{
    return (struct dig_approach){ .depth = 1.0 };
}

struct dig_approach dig_approach_normalized(const struct dig_approach *const approach)
{
    assert(approach != NULL);
    struct dig_approach normalized = *approach;
    normalized.depth               = fabs(normalized.depth) <= 0.0 ? 1.0 : normalized.depth;
    return normalized;
}

bool dig_approach_is_same(const struct dig_approach *const a, const struct dig_approach *const b)
{
    const struct dig_approach x = dig_approach_normalized(a);
    const struct dig_approach y = dig_approach_normalized(b);
    return !(x.depth < y.depth || x.depth > y.depth || x.attack_rad < y.attack_rad ||
             x.attack_rad > y.attack_rad);
}

bool dig_approach_is_plain(const struct dig_approach *const approach)
{
    const struct dig_approach plain = dig_approach_plain();
    return dig_approach_is_same(approach, &plain);
}

void dig_approach_text(const struct dig_approach *const approach, char text[DIG_APPROACH_TEXT_SIZE])
{
    const struct dig_approach normalized = dig_approach_normalized(approach);
    text[0]                              = '\0';
    if (!dig_approach_is_plain(&normalized)) {
        (void)snprintf(text, DIG_APPROACH_TEXT_SIZE, ", depth %.6g, attack %.6g deg",
                       normalized.depth, normalized.attack_rad / DIG_RAD_PER_DEG);
    }
}

static double tooth_x_m(const struct dig_pose *const pose, const double tooth_m)
{
    return pose->x_m + tooth_m * sin(pose->theta_rad);
}

static double tooth_z_m(const struct dig_pose *const pose, const double tooth_m)
{
    return pose->z_m - tooth_m * cos(pose->theta_rad);
}

double dig_approach_depth_m(const struct dig_scene *const      scene,
                            const struct dig_trajectory *const trajectory)
{
    assert(scene != NULL && trajectory != NULL && trajectory->phases >= 1);
    const double          tooth_m = dig_scene_tooth_m(scene);
    const struct dig_pose end = dig_trajectory_pose(trajectory, trajectory->phase[0].duration_s);
    return dig_scene_ground_m(scene, tooth_x_m(&end, tooth_m), 0.0) - tooth_z_m(&end, tooth_m);
}

static enum dig_status check_range(const struct dig_approach *const   approach,
                                   const struct dig_trajectory *const trajectory,
                                   struct dig_error *const            error)
{
    struct dig_conditions c = { .error = error };
    dig_require(&c,
                approach->depth >= DIG_APPROACH_DEPTH_LEAST &&
                    approach->depth <= DIG_APPROACH_DEPTH_MOST,
                "trajectory %s: depth %g, expected %g to %g", trajectory->name, approach->depth,
                DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST);
    dig_require(&c, fabs(approach->attack_rad) <= DIG_APPROACH_ATTACK_MOST_rad * (1.0 + 1e-12),
                "trajectory %s: attack %g deg, expected -45 to 45 deg", trajectory->name,
                approach->attack_rad / DIG_RAD_PER_DEG);
    return c.status;
}

enum dig_status dig_approach_apply(const struct dig_trajectory *const trajectory,
                                   const double tooth_m, const double depth_m,
                                   const struct dig_approach *const approach,
                                   struct dig_trajectory *const made, struct dig_error *const error)
{
    assert(trajectory != NULL && approach != NULL && made != NULL && trajectory->phases >= 1);
    const struct dig_approach normalized = dig_approach_normalized(approach);
    const enum dig_status     status     = check_range(&normalized, trajectory, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_trajectory   dug   = *trajectory;
    struct dig_phase *const first = &dug.phase[0];
    if (normalized.depth < 1.0 || normalized.depth > 1.0) {
        const double down_m = -first->vz_mps * first->duration_s;
        const double scale  = 1.0 + (normalized.depth - 1.0) * depth_m / down_m;
        if (!(down_m > 0.0 && depth_m > 0.0 && scale > 0.0)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "trajectory %s: depth %g, expected 1: its first phase does not go "
                                 "down below the ground",
                                 trajectory->name, normalized.depth);
        }
        first->vx_mps *= scale;
        first->vz_mps *= scale;
    }
    if (fabs(normalized.attack_rad) > 0.0) {
        const struct dig_pose plain = { dug.start_x_m, dug.start_z_m, dug.theta0_rad };
        dug.theta0_rad += normalized.attack_rad;
        dug.start_x_m = tooth_x_m(&plain, tooth_m) - tooth_m * sin(dug.theta0_rad);
        dug.start_z_m = tooth_z_m(&plain, tooth_m) + tooth_m * cos(dug.theta0_rad);
    }
    *made = dug;
    return DIG_OK;
}

// How far the bucket's profile reaches below the ground where the trajectory starts, m.
static double start_in_ground_m(const struct dig_scene *const      scene,
                                const struct dig_trajectory *const trajectory)
{
    const struct dig_pose pose = dig_trajectory_pose(trajectory, 0.0);
    const double          c    = cos(pose.theta_rad);
    const double          s    = sin(pose.theta_rad);
    double                in_m = -INFINITY;
    for (size_t k = 0; k < scene->bucket.points; k++) {
        const double x_m = pose.x_m + c * scene->bucket.x_m[k] - s * scene->bucket.z_m[k];
        const double z_m = pose.z_m + s * scene->bucket.x_m[k] + c * scene->bucket.z_m[k];
        // The ground is highest across the bucket at an end or at a profile.
        const double half_m = 0.5 * scene->bucket.width_m;
        in_m                = fmax(in_m, dig_scene_ground_m(scene, x_m, -half_m) - z_m);
        in_m                = fmax(in_m, dig_scene_ground_m(scene, x_m, half_m) - z_m);
        for (size_t p = 0; p < scene->bed.profiles; p++) {
            const double y_m = scene->bed.profile[p].y_m;
            if (fabs(y_m) < half_m) {
                in_m = fmax(in_m, dig_scene_ground_m(scene, x_m, y_m) - z_m);
            }
        }
    }
    return in_m;
}

enum dig_status dig_approach_make(const struct dig_scene *const      scene,
                                  const struct dig_trajectory *const trajectory,
                                  const struct dig_approach *const   approach,
                                  struct dig_trajectory *const made, struct dig_error *const error)
{
    assert(scene != NULL && trajectory != NULL && approach != NULL && made != NULL);
    struct dig_trajectory dug;
    const enum dig_status status =
        dig_approach_apply(trajectory, dig_scene_tooth_m(scene),
                           dig_approach_depth_m(scene, trajectory), approach, &dug, error);
    if (status != DIG_OK) {
        return status;
    }
    const double in_m   = start_in_ground_m(scene, &dug);
    const double most_m = heel_in_grains * scene->material.diameter_m;
    if (in_m > most_m && in_m > start_in_ground_m(scene, trajectory)) {
        char text[DIG_APPROACH_TEXT_SIZE];
        dig_approach_text(approach, text);
        return dig_error_set(error, DIG_EINVAL,
                             "trajectory %s%s: the bucket starts %.3g m in the ground, expected it "
                             "clear of it",
                             trajectory->name, text, in_m);
    }
    *made = dug;
    return DIG_OK;
}
