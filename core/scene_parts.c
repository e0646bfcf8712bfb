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

double dig_scene_young_Pa(const struct dig_scene *const scene, const double density_kgpm3)
{
    assert(scene != NULL);
    const struct dig_material *const m = &scene->material;
    return m->young_at_kgpm3 > 0.0 ? m->young_Pa * (density_kgpm3 / m->young_at_kgpm3)
                                   : m->young_Pa;
}

const struct dig_material_pair *dig_scene_bucket_pair(const struct dig_scene *const scene)
{
    assert(scene != NULL);
    for (size_t i = 0; i < scene->bed.pairs; i++) {
        const struct dig_material_pair *const p = &scene->bed.pair[i];
        if ((p->a == 0 && p->b == DIG_MATERIAL_BUCKET) ||
            (p->b == 0 && p->a == DIG_MATERIAL_BUCKET)) {
            return p;
        }
    }
    return NULL;
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
