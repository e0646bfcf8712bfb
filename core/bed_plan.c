#include "core/bed_plan.h"

#include "core/name.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void dig_scene_check_ranges(const char *const list, const size_t at, const size_t n,
                            const struct dig_scene_range range[], struct dig_conditions *const c)
{
    char entry[64] = "";
    if (list != NULL) {
        (void)snprintf(entry, sizeof entry, "%s[%zu].", list, at);
    }
    for (size_t i = 0; i < n; i++) {
        const struct dig_scene_range *const r = &range[i];
        dig_require(
            c, r->value >= r->least && r->value <= r->most && (!r->above || r->value > r->least),
            "%s%s: %g, expected %s %g and <= %g", entry, r->key, r->value,
            r->above ? ">" : ">=", r->least, r->most);
    }
}

static void check_counts(const struct dig_bed_plan *const bed, struct dig_conditions *const c)
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
        dig_require(c, list[i].count <= list[i].most, "%s: %zu, expected at most %zu", list[i].key,
                    list[i].count, list[i].most);
    }
}

static void check_sizes(const struct dig_scene *const scene, struct dig_conditions *const c)
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
        dig_scene_check_ranges("bed.sizes", i, 2, range, c);
        sum += bed->size[i].mass_fraction;
    }
    dig_require(c, bed->sizes == 0 || fabs(sum - 1.0) <= 1e-6,
                "bed.sizes: mass fractions add up to %.9g, expected 1", sum);
}

static void check_materials(const struct dig_bed_plan *const bed, struct dig_conditions *const c)
{
    for (size_t i = 0; i < bed->materials; i++) {
        const struct dig_other_material *const m       = &bed->material[i];
        const struct dig_scene_range           range[] = {
                      { "friction", m->friction, 0.0, 10.0, false },
                      { "rolling", m->rolling, 0.0, 10.0, false },
                      { "density_kgpm3", m->density_kgpm3, 0.0, 1e5, true },
                      { "restitution", m->restitution, 0.0, 1.0, true },
        };
        dig_scene_check_ranges("bed.materials", i, 4, range, c);
        dig_require(c, dig_name_ok(m->name),
                    "bed.materials[%zu].name: \"%s\", expected " DIG_NAME_RULE, i, m->name);
        bool known = false;
        for (size_t k = 0; k <= DIG_MATERIAL_WALLS; k++) {
            known = known || (k != i + 1 && strcmp(dig_material_name(bed, k), m->name) == 0);
        }
        dig_require(c, !known,
                    "bed.materials[%zu].name: \"%s\", expected a name of its own, not "
                    "gravel, bucket or walls",
                    i, m->name);
    }
    for (size_t i = 0; i < bed->pairs; i++) {
        const struct dig_material_pair *const p       = &bed->pair[i];
        const struct dig_scene_range          range[] = {
                     { "friction", p->friction, 0.0, 10.0, false },
                     { "rolling", p->rolling, 0.0, 10.0, false },
                     { "restitution", p->restitution, 0.0, 1.0, true },
        };
        dig_scene_check_ranges("bed.pairs", i, 3, range, c);
        dig_require(c,
                    dig_material_name(bed, p->a)[0] != '\0' &&
                        dig_material_name(bed, p->b)[0] != '\0' &&
                        (p->a < DIG_MATERIAL_BUCKET || p->b < DIG_MATERIAL_BUCKET),
                    "bed.pairs[%zu].between: expected two of gravel, the materials, bucket "
                    "and walls, one of them a material of grains",
                    i);
    }
}

static void check_layers(const struct dig_bed_plan *const bed, struct dig_conditions *const c)
{
    for (size_t i = 0; i < bed->layers; i++) {
        const struct dig_layer *const l = &bed->layer[i];
        dig_require(c, l->material <= bed->materials,
                    "bed.layers[%zu].material: expected gravel or one of bed.materials", i);
        dig_require(c, isfinite(l->from_m) && isfinite(l->to_m) && l->to_m > l->from_m,
                    "bed.layers[%zu].z_m: [%g, %g], expected two numbers, ascending", i, l->from_m,
                    l->to_m);
    }
}

// Points of one profile, which `key` names.
static void check_profile(const struct dig_scene *const scene, const char *const key,
                          const size_t points, const double x[], const double z[],
                          struct dig_conditions *const c)
{
    const double floor_m = scene->box.z_min_m;
    const double most_m  = floor_m + 5.0 * (scene->box.z_max_m - floor_m);
    dig_require(c, points >= 2 && points <= DIG_SURFACE_MAX,
                "%s: %zu points, expected none or 2 to %d", key, points, DIG_SURFACE_MAX);
    for (size_t i = 0; c->status == DIG_OK && i < points; i++) {
        dig_require(
            c, isfinite(x[i]) && z[i] > floor_m && z[i] <= most_m && (i == 0 || x[i] > x[i - 1]),
            "%s[%zu]: [%g, %g], expected x ascending and z above the floor, at most "
            "five times the box's height",
            key, i, x[i], z[i]);
    }
}

static void check_surface(const struct dig_scene *const scene, struct dig_conditions *const c)
{
    const struct dig_bed_plan *const bed = &scene->bed;
    if (bed->surface > 0) {
        check_profile(scene, "bed.surface_m", bed->surface, bed->surface_x_m, bed->surface_z_m, c);
    }
    dig_require(c, bed->profiles == 0 || bed->surface == 0,
                "bed.surfaces: expected none beside surface_m");
    dig_require(c, bed->profiles == 0 || !bed->periodic_y,
                "bed.surfaces: expected none where sides are one (periodic_y)");
    for (size_t k = 0; k < bed->profiles; k++) {
        const struct dig_ground_profile *const p = &bed->profile[k];
        char                                   key[48];
        (void)snprintf(key, sizeof key, "bed.surfaces[%zu].surface_m", k);
        dig_require(c, isfinite(p->y_m) && (k == 0 || p->y_m > p[-1].y_m),
                    "bed.surfaces[%zu].y_m: %g, expected ascending", k, p->y_m);
        check_profile(scene, key, p->points, p->x_m, p->z_m, c);
    }
}

static void check_clump(const struct dig_clump *const clump, struct dig_conditions *const c)
{
    dig_require(c, clump->spheres != 1,
                "bed.clump: 1 sphere, expected none or 2 to %d (one alone is a sphere)",
                DIG_CLUMP_MAX);
    for (size_t i = 0; i < clump->spheres; i++) {
        dig_require(c,
                    clump->radius[i] > 0.0 && clump->radius[i] <= 100.0 &&
                        fabs(clump->x[i]) + fabs(clump->y[i]) + fabs(clump->z[i]) <= 100.0,
                    "bed.clump[%zu]: expected a centre within 100 of the origin and a radius "
                    "> 0 and <= 100",
                    i);
    }
}

static void check_obstacles(const struct dig_bed_plan *const bed, struct dig_conditions *const c)
{
    for (size_t i = 0; i < bed->obstacles; i++) {
        const struct dig_obstacle *const o     = &bed->obstacle[i];
        const bool                       box   = o->shape == DIG_OBSTACLE_BOX;
        bool                             sound = true;
        for (size_t k = 0; k < 3; k++) {
            sound = sound && isfinite(o->centre_m[k]) &&
                    ((k > 0 && !box) || (o->size_m[k] > 0.0 && o->size_m[k] <= 100.0));
        }
        dig_require(c, sound,
                    "bed.obstacles[%zu]: expected a finite centre_m and %s > 0 and <= 100", i,
                    box ? "edges_m" : "diameter_m");
        dig_require(c, !o->movable || (o->density_kgpm3 > 0.0 && o->density_kgpm3 <= 1e5),
                    "bed.obstacles[%zu].density_kgpm3: %g, expected > 0 and <= 1e5 for one "
                    "that is movable",
                    i, o->density_kgpm3);
    }
}

// Without sides y repeats about 0, and nothing may meet its own image.
static void check_period(const struct dig_scene *const scene, struct dig_conditions *const c)
{
    const struct dig_box *const box       = &scene->box;
    double                      largest_m = scene->material.diameter_m;
    if (!scene->bed.periodic_y) {
        return;
    }
    for (size_t i = 0; i < scene->bed.sizes; i++) {
        largest_m = fmax(largest_m, scene->bed.size[i].diameter_m);
    }
    const double least_m = scene->bucket.width_m + 4.0 * largest_m;
    dig_require(c,
                fabs(box->y_min_m + box->y_max_m) <= 1e-9 * least_m &&
                    box->y_max_m - box->y_min_m > least_m,
                "box_m.y: [%g, %g], expected as much to both sides of 0 with "
                "bed.periodic_y, and %g m in all",
                box->y_min_m, box->y_max_m, least_m);
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        dig_require(c, !scene->bed.obstacle[i].movable,
                    "bed.obstacles[%zu].movable: true, expected false with bed.periodic_y", i);
    }
}

void dig_bed_plan_check(const struct dig_scene *const scene, struct dig_conditions *const c)
{
    const char *const            earlier = scene->bed.earlier;
    const struct dig_scene_range range[] = {
        { "laws.cohesion_Jpm3", scene->laws.cohesion_Jpm3, 0.0, 1e9, false },
        { "laws.adhesion_Jpm3", scene->laws.adhesion_Jpm3, 0.0, 1e9, false },
        { "laws.bucket_smoothness", scene->laws.bucket_smoothness, 0.0, 1.0, false },
        { "bed.preload_Pa", scene->bed.preload_Pa, 0.0, 1e9, false },
    };
    dig_scene_check_ranges(NULL, 0, sizeof range / sizeof range[0], range, c);
    check_counts(&scene->bed, c);
    if (c->status != DIG_OK) {
        return; // lists that are longer than their room
    }
    check_sizes(scene, c);
    check_materials(&scene->bed, c);
    check_layers(&scene->bed, c);
    check_surface(scene, c);
    check_clump(&scene->bed.clump, c);
    check_obstacles(&scene->bed, c);
    check_period(scene, c);
    dig_require(c, earlier[0] == '\0' || dig_scene_find(scene, earlier) != NULL,
                "bed.earlier: \"%s\", expected one of the scene's trajectories", earlier);
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
