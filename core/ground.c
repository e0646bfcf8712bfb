#include "core/ground.h"

#include <math.h>

// Which two neighbours of ascending x[n] lie about `at`, and the share of the second: before the
// first and behind the last that one alone.
struct between {
    size_t first, second;
    double share;
};

static struct between find_between(const size_t n, const double x[], const double at)
{
    if (at <= x[0]) {
        return (struct between){ 0, 0, 0.0 };
    }
    for (size_t i = 1; i < n; i++) {
        if (at <= x[i]) {
            return (struct between){ i - 1, i, (at - x[i - 1]) / (x[i] - x[i - 1]) };
        }
    }
    return (struct between){ n - 1, n - 1, 0.0 };
}

static double height(const size_t n, const double x[], const double z[], const double at)
{
    const struct between b = find_between(n, x, at);
    return z[b.first] + (z[b.second] - z[b.first]) * b.share;
}

double dig_scene_ground_m(const struct dig_scene *const scene, const double x_m, const double y_m)
{
    const struct dig_bed_plan *const bed = &scene->bed;
    if (bed->profiles > 0) {
        double z_m[DIG_PROFILES_MAX];
        double at_m[DIG_PROFILES_MAX];
        for (size_t k = 0; k < bed->profiles; k++) {
            const struct dig_ground_profile *const p = &bed->profile[k];
            at_m[k]                                  = p->y_m;
            z_m[k]                                   = height(p->points, p->x_m, p->z_m, x_m);
        }
        return height(bed->profiles, at_m, z_m, y_m);
    }
    return bed->surface == 0 ? scene->box.z_max_m
                             : height(bed->surface, bed->surface_x_m, bed->surface_z_m, x_m);
}

// The highest of a profile's points inside the box.
static double highest_point(const struct dig_box *const box, const size_t n, const double x[],
                            const double z[])
{
    double most_m = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        if (x[i] > box->x_min_m && x[i] < box->x_max_m) {
            most_m = fmax(most_m, z[i]);
        }
    }
    return most_m;
}

double dig_scene_ground_max_m(const struct dig_scene *const scene)
{
    const struct dig_bed_plan *const bed    = &scene->bed;
    const struct dig_box *const      box    = &scene->box;
    const double                     x_m[2] = { box->x_min_m, box->x_max_m };
    double most_m = highest_point(box, bed->surface, bed->surface_x_m, bed->surface_z_m);
    for (int end = 0; end < 2; end++) {
        most_m = fmax(most_m, dig_scene_ground_m(scene, x_m[end], box->y_min_m));
        most_m = fmax(most_m, dig_scene_ground_m(scene, x_m[end], box->y_max_m));
        for (size_t k = 0; k < bed->profiles; k++) {
            most_m = fmax(most_m, dig_scene_ground_m(scene, x_m[end], bed->profile[k].y_m));
        }
    }
    // Between two profiles no place is higher than the higher of them.
    for (size_t k = 0; k < bed->profiles; k++) {
        const struct dig_ground_profile *const p = &bed->profile[k];
        most_m = fmax(most_m, highest_point(box, p->points, p->x_m, p->z_m));
    }
    return most_m;
}
