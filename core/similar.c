#include "core/similar.h"

#include <assert.h>
#include <math.h>

// Stiffness of a linear contact goes with (E sqrt(v))^(4/5); see the header for the bound.
#define STIFFNESS_FACTOR 1.75

static bool is_close(const double a, const double b, const double size)
{
    return fabs(a - b) <= DIG_SIMILAR * size;
}

// size: of both, where each is drawn at its own.
static void require_close(struct dig_conditions *const c, const char *const key, const double found,
                          const double expected, const double size)
{
    dig_require(c, is_close(found / size, expected, expected),
                "%s: %.4g, expected %.4g within %.0f %%", key, found, expected * size,
                100.0 * DIG_SIMILAR);
}

double dig_scene_scale(const struct dig_scene *const scene, const struct dig_scene *const other)
{
    return dig_scene_tooth_m(scene) / dig_scene_tooth_m(other);
}

static double off_segment_m(const double x_m, const double z_m, const struct dig_bucket *const b,
                            const size_t i)
{
    const double along_x_m = b->x_m[i + 1] - b->x_m[i];
    const double along_z_m = b->z_m[i + 1] - b->z_m[i];
    const double square_m2 = along_x_m * along_x_m + along_z_m * along_z_m;
    const double at =
        ((x_m - b->x_m[i]) * along_x_m + (z_m - b->z_m[i]) * along_z_m) / fmax(square_m2, 1e-30);
    const double f = fmin(fmax(at, 0.0), 1.0);
    return hypot(x_m - b->x_m[i] - f * along_x_m, z_m - b->z_m[i] - f * along_z_m);
}

// How far the farthest of a's points, drawn at this size, is from b's outline. Both may be drawn
// with points of their own.
static double off_outline_m(const struct dig_bucket *const a, const double size,
                            const struct dig_bucket *const b)
{
    double most_m = 0.0;
    for (size_t p = 0; p < a->points; p++) {
        double least_m = (double)INFINITY;
        for (size_t i = 0; i + 1 < b->points; i++) {
            least_m = fmin(least_m, off_segment_m(a->x_m[p] * size, a->z_m[p] * size, b, i));
        }
        most_m = fmax(most_m, least_m);
    }
    return most_m;
}

static void compare_buckets(const struct dig_scene *const scene,
                            const struct dig_scene *const other, const double scale,
                            struct dig_conditions *const c)
{
    const struct dig_bucket *const a = &scene->bucket;
    const struct dig_bucket *const b = &other->bucket;
    require_close(c, "bucket.width_m", a->width_m, b->width_m, scale);
    const double off_m = fmax(off_outline_m(a, 1.0 / scale, b), off_outline_m(b, scale, a) / scale);
    const double share = off_m / dig_scene_tooth_m(other);
    dig_require(c, share <= DIG_SIMILAR,
                "bucket.profile_m: an outline %.0f %% of the bucket's length off, expected at most "
                "%.0f %%",
                100.0 * share, 100.0 * DIG_SIMILAR);
}

static void compare_boxes(const struct dig_scene *const scene, const struct dig_scene *const other,
                          const double scale, struct dig_conditions *const c)
{
    const struct dig_box *const a = &scene->box;
    const struct dig_box *const b = &other->box;
    require_close(c, "box_m.x: length", a->x_max_m - a->x_min_m, b->x_max_m - b->x_min_m, scale);
    require_close(c, "box_m.y: width", a->y_max_m - a->y_min_m, b->y_max_m - b->y_min_m, scale);
    require_close(c, "box_m.z: depth", a->z_max_m - a->z_min_m, b->z_max_m - b->z_min_m, scale);
    dig_require(c, scene->bed.periodic_y == other->bed.periodic_y,
                "bed.periodic_y: %s, expected %s",
                scene->bed.periodic_y ? "no walls in y" : "walls in y",
                other->bed.periodic_y ? "none" : "walls");
}

static double stiffness(const struct dig_scene *const scene)
{
    return scene->material.young_Pa * (scene->laws.normal == DIG_NORMAL_HERTZ
                                           ? 1.0
                                           : sqrt(scene->material.characteristic_velocity_mps));
}

static void compare_grains(const struct dig_scene *const scene, const struct dig_scene *const other,
                           const double scale, struct dig_conditions *const c)
{
    const struct dig_material *const a = &scene->material;
    const struct dig_material *const b = &other->material;
    require_close(c, "gravity_mps2", scene->gravity_mps2, other->gravity_mps2, 1.0);
    require_close(c, "material.diameter_m", a->diameter_m, b->diameter_m, scale);
    const double velocity = scene->laws.normal == DIG_NORMAL_HERTZ ? 1.0 : pow(scale, 0.25);
    const double ratio    = stiffness(scene) / (stiffness(other) * scale * velocity);
    // Stiffnesses of two laws say nothing of each other.
    dig_require(c,
                scene->laws.normal != other->laws.normal ||
                    (ratio <= STIFFNESS_FACTOR && ratio >= 1.0 / STIFFNESS_FACTOR),
                "material.young_Pa: %.4g, contacts %.3g times as stiff as expected of %.4g scaled, "
                "within a factor of %.2f",
                a->young_Pa, ratio, b->young_Pa, STIFFNESS_FACTOR);
}

// Where the bucket is when this share of its path is done: from the end wall, from the ground.
static struct dig_pose pose_at(const struct dig_scene *const      scene,
                               const struct dig_trajectory *const t, const double progress)
{
    const double    tooth_m = dig_scene_tooth_m(scene);
    struct dig_pose pose    = dig_trajectory_pose(t, dig_trajectory_time_s(t, tooth_m, progress));
    pose.x_m -= scene->box.x_min_m;
    pose.z_m -= scene->box.z_max_m;
    return pose;
}

static void compare_ways(const struct dig_scene *const scene, const struct dig_trajectory *const t,
                         const struct dig_scene *const other, const double scale,
                         struct dig_conditions *const c)
{
    enum { STEPS = 64 };
    const struct dig_trajectory *const own     = dig_scene_find(other, t->name);
    const double                       tooth_m = dig_scene_tooth_m(other);
    for (int i = 0; i <= STEPS && own != NULL; i++) {
        const double          progress = (double)i / STEPS;
        const struct dig_pose a        = pose_at(scene, t, progress);
        const struct dig_pose b        = pose_at(other, own, progress);
        dig_require(c,
                    is_close(a.x_m / scale, b.x_m, tooth_m) &&
                        is_close(a.z_m / scale, b.z_m, tooth_m) &&
                        is_close(a.theta_rad, b.theta_rad, 1.0),
                    "trajectory \"%s\": elsewhere when %.0f %% of the path is done, expected "
                    "within %.0f %% of the bucket's length",
                    t->name, 100.0 * progress, 100.0 * DIG_SIMILAR);
    }
}

enum dig_status dig_scene_similar(const struct dig_scene *const scene,
                                  const struct dig_scene *const other,
                                  struct dig_error *const       error)
{
    assert(scene != NULL && other != NULL);
    struct dig_conditions c     = { .error = error };
    const double          scale = dig_scene_scale(scene, other);
    compare_buckets(scene, other, scale, &c);
    compare_boxes(scene, other, scale, &c);
    compare_grains(scene, other, scale, &c);
    for (size_t i = 0; i < scene->trajectories; i++) {
        compare_ways(scene, &scene->trajectory[i], other, scale, &c);
    }
    return c.status;
}

enum dig_status dig_bucket_similar(const struct dig_machine *const   machine,
                                   const struct dig_curve_set *const set,
                                   struct dig_error *const           error)
{
    assert(machine != NULL && set != NULL);
    const double shape = machine->bucket_width_m / machine->link[DIG_JOINT_BUCKET].length_m;
    const double scene = set->bucket_width_m / set->tooth_m;
    return is_close(shape, scene, scene)
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "scene \"%s\" has a bucket %.3f times as wide as long, machine "
                               "\"%s\" one %.3f times; expected the same shape within %.0f %%",
                               set->scene_name, scene, machine->name, shape, 100.0 * DIG_SIMILAR);
}
