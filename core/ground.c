#include "core/ground.h"

#include <math.h>

double dig_scene_ground_m(const struct dig_scene *const scene, const double x_m)
{
    const struct dig_bed_plan *const bed = &scene->bed;
    const double *const              x   = bed->surface_x_m;
    const double *const              z   = bed->surface_z_m;
    if (bed->surface == 0) {
        return scene->box.z_max_m;
    }
    if (x_m <= x[0]) {
        return z[0];
    }
    for (size_t i = 1; i < bed->surface; i++) {
        if (x_m <= x[i]) {
            return z[i - 1] + (z[i] - z[i - 1]) * (x_m - x[i - 1]) / (x[i] - x[i - 1]);
        }
    }
    return z[bed->surface - 1];
}

double dig_scene_ground_max_m(const struct dig_scene *const scene)
{
    double most_m = fmax(dig_scene_ground_m(scene, scene->box.x_min_m),
                         dig_scene_ground_m(scene, scene->box.x_max_m));
    for (size_t i = 0; i < scene->bed.surface; i++) {
        const double x_m = scene->bed.surface_x_m[i];
        if (x_m > scene->box.x_min_m && x_m < scene->box.x_max_m) {
            most_m = fmax(most_m, scene->bed.surface_z_m[i]);
        }
    }
    return most_m;
}
