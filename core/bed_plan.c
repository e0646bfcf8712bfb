#include "core/bed_plan.h"

#include "core/name.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY_SIZE 64

enum dig_status dig_scene_check_ranges(const char *const list, const size_t at, const size_t n,
                                       const struct dig_scene_range range[],
                                       struct dig_error *const      error)
{
    for (size_t i = 0; i < n; i++) {
        const struct dig_scene_range *const r = &range[i];
        if (!(r->value >= r->least && r->value <= r->most && (!r->above || r->value > r->least))) {
            char key[KEY_SIZE];
            if (list == NULL) {
                (void)snprintf(key, sizeof key, "%s", r->key);
            } else {
                (void)snprintf(key, sizeof key, "%s[%zu].%s", list, at, r->key);
            }
            return dig_error_set(error, DIG_EINVAL, "%s: %g, expected %s %g and <= %g", key,
                                 r->value, r->above ? ">" : ">=", r->least, r->most);
        }
    }
    return DIG_OK;
}

static enum dig_status check_counts(const struct dig_bed_plan *const bed,
                                    struct dig_error *const          error)
{
    const struct {
        const char *key;
        size_t      count, most;
    } list[] = {
        { "bed.sizes", bed->sizes, DIG_SIZES_MAX },
        { "bed.materials", bed->materials, DIG_MATERIALS_MAX },
        { "bed.pairs", bed->pairs, DIG_PAIRS_MAX },
        { "bed.layers", bed->layers, DIG_LAYERS_MAX },
        { "bed.surface_m", bed->surface, DIG_SURFACE_MAX },
        { "bed.surfaces", bed->profiles, DIG_PROFILES_MAX },
        { "bed.clump", bed->clump.spheres, DIG_CLUMP_MAX },
        { "bed.obstacles", bed->obstacles, DIG_OBSTACLES_MAX },
        { "bed.earlier_digs", bed->earlier_digs, DIG_EARLIER_MAX },
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        if (list[i].count > list[i].most) {
            return dig_error_set(error, DIG_EINVAL, "%s: %zu, expected at most %zu", list[i].key,
                                 list[i].count, list[i].most);
        }
    }
    return DIG_OK;
}

static enum dig_status check_sizes(const struct dig_scene *const scene,
                                   struct dig_error *const       error)
{
    const struct dig_bed_plan *const bed         = &scene->bed;
    const struct dig_box *const      box         = &scene->box;
    const double                     narrowest_m = fmin(box->x_max_m - box->x_min_m,
                                                        fmin(box->y_max_m - box->y_min_m, box->z_max_m - box->z_min_m));
    double                           sum         = 0.0;
    for (size_t i = 0; i < bed->sizes; i++) {
        const struct dig_scene_range range[] = {
            { "diameter_m", bed->size[i].diameter_m, 0.0, 0.5 * narrowest_m, true },
            { "mass_fraction", bed->size[i].mass_fraction, 0.0, 1.0, true },
        };
        const enum dig_status status = dig_scene_check_ranges("bed.sizes", i, 2, range, error);
        if (status != DIG_OK) {
            return status;
        }
        sum += bed->size[i].mass_fraction;
    }
    if (bed->sizes > 0 && !(fabs(sum - 1.0) <= 1e-6)) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed.sizes: mass fractions add up to %.9g, expected 1", sum);
    }
    return DIG_OK;
}

static enum dig_status check_materials(const struct dig_bed_plan *const bed,
                                       struct dig_error *const          error)
{
    for (size_t i = 0; i < bed->materials; i++) {
        const struct dig_other_material *const m       = &bed->material[i];
        const struct dig_scene_range           range[] = {
                      { "friction", m->friction, 0.0, 10.0, false },
                      { "rolling", m->rolling, 0.0, 10.0, false },
                      { "density_kgpm3", m->density_kgpm3, 0.0, 1e5, true },
                      { "restitution", m->restitution, 0.0, 1.0, true },
        };
        const enum dig_status status = dig_scene_check_ranges("bed.materials", i, 4, range, error);
        if (status != DIG_OK) {
            return status;
        }
        if (!dig_name_ok(m->name)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.materials[%zu].name: \"%s\", expected " DIG_NAME_RULE, i,
                                 m->name);
        }
        bool known = false;
        for (size_t k = 0; k <= DIG_MATERIAL_WALLS; k++) {
            known = known || (k != i + 1 && strcmp(dig_material_name(bed, k), m->name) == 0);
        }
        if (known) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.materials[%zu].name: \"%s\", expected a name of its own, not "
                                 "gravel, bucket or walls",
                                 i, m->name);
        }
    }
    for (size_t i = 0; i < bed->pairs; i++) {
        const struct dig_material_pair *const p       = &bed->pair[i];
        const struct dig_scene_range          range[] = {
                     { "friction", p->friction, 0.0, 10.0, false },
                     { "rolling", p->rolling, 0.0, 10.0, false },
                     { "restitution", p->restitution, 0.0, 1.0, true },
        };
        const enum dig_status status = dig_scene_check_ranges("bed.pairs", i, 3, range, error);
        if (status != DIG_OK) {
            return status;
        }
        if (dig_material_name(bed, p->a)[0] == '\0' || dig_material_name(bed, p->b)[0] == '\0' ||
            (p->a >= DIG_MATERIAL_BUCKET && p->b >= DIG_MATERIAL_BUCKET)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.pairs[%zu].between: expected two of gravel, the materials, "
                                 "bucket and walls, one of them a material of grains",
                                 i);
        }
    }
    return DIG_OK;
}

static enum dig_status check_layers(const struct dig_bed_plan *const bed,
                                    struct dig_error *const          error)
{
    for (size_t i = 0; i < bed->layers; i++) {
        const struct dig_layer *const layer = &bed->layer[i];
        if (layer->material > bed->materials) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.layers[%zu].material: expected gravel or one of "
                                 "bed.materials",
                                 i);
        }
        if (!(isfinite(layer->from_m) && isfinite(layer->to_m) && layer->to_m > layer->from_m)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.layers[%zu].z_m: [%g, %g], expected two numbers, ascending",
                                 i, layer->from_m, layer->to_m);
        }
    }
    return DIG_OK;
}

// Points of one profile, which `key` names.
static enum dig_status check_profile(const struct dig_scene *const scene, const char *const key,
                                     const size_t points, const double x[], const double z[],
                                     struct dig_error *const error)
{
    if (points < 2 || points > DIG_SURFACE_MAX) {
        return dig_error_set(error, DIG_EINVAL, "%s: %zu points, expected none or 2 to %d", key,
                             points, DIG_SURFACE_MAX);
    }
    for (size_t i = 0; i < points; i++) {
        if (!(isfinite(x[i]) && z[i] > scene->box.z_min_m &&
              z[i] <= scene->box.z_min_m + 5.0 * (scene->box.z_max_m - scene->box.z_min_m)) ||
            (i > 0 && !(x[i] > x[i - 1]))) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s[%zu]: [%g, %g], expected x ascending and z above "
                                 "the floor, at most five times the box's height",
                                 key, i, x[i], z[i]);
        }
    }
    return DIG_OK;
}

static enum dig_status check_surface(const struct dig_scene *const scene,
                                     struct dig_error *const       error)
{
    const struct dig_bed_plan *const bed    = &scene->bed;
    enum dig_status                  status = bed->surface == 0
                                                  ? DIG_OK
                                                  : check_profile(scene, "bed.surface_m", bed->surface,
                                                                  bed->surface_x_m, bed->surface_z_m, error);
    if (status == DIG_OK && bed->profiles > 0 && bed->surface > 0) {
        return dig_error_set(error, DIG_EINVAL, "bed.surfaces: expected none beside surface_m");
    }
    if (status == DIG_OK && bed->profiles > 0 && bed->periodic_y) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed.surfaces: expected none where sides are one (periodic_y)");
    }
    for (size_t k = 0; k < bed->profiles && status == DIG_OK; k++) {
        const struct dig_ground_profile *const p = &bed->profile[k];
        char                                   key[48];
        (void)snprintf(key, sizeof key, "bed.surfaces[%zu].surface_m", k);
        if (!isfinite(p->y_m) || (k > 0 && !(p->y_m > p[-1].y_m))) {
            return dig_error_set(error, DIG_EINVAL, "bed.surfaces[%zu].y_m: %g, expected ascending",
                                 k, p->y_m);
        }
        status = check_profile(scene, key, p->points, p->x_m, p->z_m, error);
    }
    return status;
}

static enum dig_status check_clump(const struct dig_clump *const clump,
                                   struct dig_error *const       error)
{
    if (clump->spheres == 1) {
        return dig_error_set(
            error, DIG_EINVAL,
            "bed.clump: 1 sphere, expected none or 2 to %d (one alone is a sphere)", DIG_CLUMP_MAX);
    }
    for (size_t i = 0; i < clump->spheres; i++) {
        if (!(clump->radius[i] > 0.0 && clump->radius[i] <= 100.0) ||
            !(fabs(clump->x[i]) + fabs(clump->y[i]) + fabs(clump->z[i]) <= 100.0)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.clump[%zu]: expected a centre within 100 of the origin and a "
                                 "radius > 0 and <= 100",
                                 i);
        }
    }
    return DIG_OK;
}

static enum dig_status check_obstacles(const struct dig_bed_plan *const bed,
                                       struct dig_error *const          error)
{
    for (size_t i = 0; i < bed->obstacles; i++) {
        const struct dig_obstacle *const o     = &bed->obstacle[i];
        const bool                       box   = o->shape == DIG_OBSTACLE_BOX;
        bool                             sound = true;
        for (size_t k = 0; k < 3; k++) {
            sound = sound && isfinite(o->centre_m[k]) &&
                    ((k > 0 && !box) || (o->size_m[k] > 0.0 && o->size_m[k] <= 100.0));
        }
        if (!sound) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu]: expected a finite centre_m and %s > 0 and "
                                 "<= 100",
                                 i, box ? "edges_m" : "diameter_m");
        }
        if (o->movable && !(o->density_kgpm3 > 0.0 && o->density_kgpm3 <= 1e5)) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu].density_kgpm3: %g, expected > 0 and <= 1e5 "
                                 "for one that is movable",
                                 i, o->density_kgpm3);
        }
    }
    return DIG_OK;
}

// Without sides y repeats about 0, and nothing may meet its own image.
static enum dig_status check_period(const struct dig_scene *const scene,
                                    struct dig_error *const       error)
{
    const struct dig_box *const box       = &scene->box;
    double                      largest_m = scene->material.diameter_m;
    if (!scene->bed.periodic_y) {
        return DIG_OK;
    }
    for (size_t i = 0; i < scene->bed.sizes; i++) {
        largest_m = fmax(largest_m, scene->bed.size[i].diameter_m);
    }
    const double least_m = scene->bucket.width_m + 4.0 * largest_m;
    if (!(fabs(box->y_min_m + box->y_max_m) <= 1e-9 * least_m) ||
        !(box->y_max_m - box->y_min_m > least_m)) {
        return dig_error_set(error, DIG_EINVAL,
                             "box_m.y: [%g, %g], expected as much to both sides of 0 with "
                             "bed.periodic_y, and %g m in all",
                             box->y_min_m, box->y_max_m, least_m);
    }
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        if (scene->bed.obstacle[i].movable) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu].movable: true, expected false with "
                                 "bed.periodic_y",
                                 i);
        }
    }
    return DIG_OK;
}

static enum dig_status check_earlier(const struct dig_scene *const scene,
                                     struct dig_error *const       error)
{
    const char *const earlier = scene->bed.earlier;
    if (earlier[0] != '\0' && dig_scene_find(scene, earlier) == NULL) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed.earlier: \"%s\", expected one of the scene's trajectories",
                             earlier);
    }
    return DIG_OK;
}

enum dig_status dig_bed_plan_check(const struct dig_scene *const scene,
                                   struct dig_error *const       error)
{
    const struct dig_scene_range range[] = {
        { "laws.cohesion_Jpm3", scene->laws.cohesion_Jpm3, 0.0, 1e9, false },
        { "laws.adhesion_Jpm3", scene->laws.adhesion_Jpm3, 0.0, 1e9, false },
        { "laws.bucket_smoothness", scene->laws.bucket_smoothness, 0.0, 1.0, false },
        { "bed.preload_Pa", scene->bed.preload_Pa, 0.0, 1e9, false },
    };
    enum dig_status status =
        dig_scene_check_ranges(NULL, 0, sizeof range / sizeof range[0], range, error);
    status = status == DIG_OK ? check_counts(&scene->bed, error) : status;
    status = status == DIG_OK ? check_sizes(scene, error) : status;
    status = status == DIG_OK ? check_materials(&scene->bed, error) : status;
    status = status == DIG_OK ? check_layers(&scene->bed, error) : status;
    status = status == DIG_OK ? check_surface(scene, error) : status;
    status = status == DIG_OK ? check_clump(&scene->bed.clump, error) : status;
    status = status == DIG_OK ? check_obstacles(&scene->bed, error) : status;
    status = status == DIG_OK ? check_period(scene, error) : status;
    return status == DIG_OK ? check_earlier(scene, error) : status;
}

const char *dig_material_name(const struct dig_bed_plan *const bed, const size_t material)
{
    if (material == 0) {
        return "gravel";
    }
    if (material >= DIG_MATERIAL_BUCKET) {
        return material == DIG_MATERIAL_BUCKET  ? "bucket"
               : material == DIG_MATERIAL_WALLS ? "walls"
                                                : "";
    }
    return material <= bed->materials ? bed->material[material - 1].name : "";
}
