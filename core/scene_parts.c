// Quantities derived from a scene: neither its check nor its identity.

#include "core/scene.h"

#include <assert.h>
#include <math.h>
#include <string.h>

double dig_scene_tooth_m(const struct dig_scene *const scene)
{
    assert(scene != NULL);
    return hypot(scene->bucket.x_m[0], scene->bucket.z_m[0]);
}

double dig_scene_period_m(const struct dig_scene *const scene)
{
    assert(scene != NULL);
    return scene->bed.periodic_y ? scene->box.y_max_m - scene->box.y_min_m : 0.0;
}

const struct dig_trajectory *dig_scene_find(const struct dig_scene *const scene,
                                            const char *const             name)
{
    assert(scene != NULL && name != NULL);
    for (size_t i = 0; i < scene->trajectories; i++) {
        if (strcmp(scene->trajectory[i].name, name) == 0) {
            return &scene->trajectory[i];
        }
    }
    return NULL;
}
