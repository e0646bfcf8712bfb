#include "files/bed_yaml.h"

#include "core/bed_plan.h"
#include "core/log_normal.h"

#include <string.h>

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL
#define SOURCE   CYAML_FIELD_IGNORE("source", CYAML_FLAG_OPTIONAL)

static const cyaml_strval_t normal_laws[] = {
    { "hooke", DIG_NORMAL_HOOKE },
    { "hertz", DIG_NORMAL_HERTZ },
};
static const cyaml_strval_t rolling_laws[] = {
    { "epsd2", DIG_ROLLING_EPSD2 },
    { "cdt", DIG_ROLLING_CDT },
    { "none", DIG_ROLLING_NONE },
};
static const cyaml_strval_t shapes[] = {
    { "sphere", DIG_OBSTACLE_SPHERE },
    { "box", DIG_OBSTACLE_BOX },
};

const cyaml_schema_field_t dig_laws_fields[] = {
    CYAML_FIELD_ENUM("normal", OPTIONAL, struct laws_text, normal, normal_laws, 2),
    CYAML_FIELD_ENUM("rolling", OPTIONAL, struct laws_text, rolling, rolling_laws, 3),
    CYAML_FIELD_FLOAT("cohesion_Jpm3", OPTIONAL, struct laws_text, cohesion_Jpm3),
    CYAML_FIELD_FLOAT("adhesion_Jpm3", OPTIONAL, struct laws_text, adhesion_Jpm3),
    CYAML_FIELD_FLOAT("bucket_smoothness", OPTIONAL, struct laws_text, bucket_smoothness),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };
static const cyaml_schema_value_t name   = { CYAML_VALUE_STRING(REQUIRED, struct name_text, 1,
                                                                DIG_NAME_SIZE - 1) };
static const cyaml_schema_value_t point  = { CYAML_VALUE_SEQUENCE_FIXED(REQUIRED, double, &number,
                                                                        2) };

static const cyaml_schema_field_t size_fields[] = {
    CYAML_FIELD_FLOAT("diameter_m", REQUIRED, struct size_text, diameter_m),
    CYAML_FIELD_FLOAT("mass_fraction", REQUIRED, struct size_text, mass_fraction),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t size = { CYAML_VALUE_MAPPING(REQUIRED, struct size_text,
                                                               size_fields) };

static const cyaml_schema_field_t log_normal_fields[] = {
    CYAML_FIELD_FLOAT("median_m", REQUIRED, struct log_normal_text, median_m),
    CYAML_FIELD_FLOAT("sigma", REQUIRED, struct log_normal_text, sigma),
    CYAML_FIELD_UINT("classes", REQUIRED, struct log_normal_text, classes),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t material_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct material_text, name, 1),
    CYAML_FIELD_FLOAT("friction", REQUIRED, struct material_text, friction),
    CYAML_FIELD_FLOAT("rolling", REQUIRED, struct material_text, rolling),
    CYAML_FIELD_FLOAT("density_kgpm3", REQUIRED, struct material_text, density_kgpm3),
    CYAML_FIELD_FLOAT("restitution", REQUIRED, struct material_text, restitution),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t material = { CYAML_VALUE_MAPPING(REQUIRED, struct material_text,
                                                                   material_fields) };

static const cyaml_schema_field_t pair_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("between", REQUIRED, struct pair_text, between, &name, 2),
    CYAML_FIELD_FLOAT("friction", REQUIRED, struct pair_text, friction),
    CYAML_FIELD_FLOAT("rolling", REQUIRED, struct pair_text, rolling),
    CYAML_FIELD_FLOAT("restitution", REQUIRED, struct pair_text, restitution),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t pair = { CYAML_VALUE_MAPPING(REQUIRED, struct pair_text,
                                                               pair_fields) };

static const cyaml_schema_field_t layer_fields[] = {
    CYAML_FIELD_STRING("material", REQUIRED, struct layer_text, material, 1),
    CYAML_FIELD_SEQUENCE_FIXED("z_m", REQUIRED, struct layer_text, z_m, &number, 2),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t layer = { CYAML_VALUE_MAPPING(REQUIRED, struct layer_text,
                                                                layer_fields) };

static const cyaml_schema_field_t profile_fields[] = {
    CYAML_FIELD_FLOAT("y_m", REQUIRED, struct profile_text, y_m),
    CYAML_FIELD_SEQUENCE("surface_m", REQUIRED, struct profile_text, surface_m, &point, 2,
                         DIG_SURFACE_MAX),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t profile = { CYAML_VALUE_MAPPING(REQUIRED, struct profile_text,
                                                                  profile_fields) };

static const cyaml_schema_field_t sphere_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("centre", REQUIRED, struct sphere_text, centre, &number, 3),
    CYAML_FIELD_FLOAT("radius", REQUIRED, struct sphere_text, radius),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t sphere = { CYAML_VALUE_MAPPING(REQUIRED, struct sphere_text,
                                                                 sphere_fields) };

static const cyaml_schema_field_t obstacle_fields[] = {
    CYAML_FIELD_ENUM("shape", REQUIRED, struct obstacle_text, shape, shapes, 2),
    CYAML_FIELD_SEQUENCE_FIXED("centre_m", REQUIRED, struct obstacle_text, centre_m, &number, 3),
    CYAML_FIELD_FLOAT("diameter_m", OPTIONAL, struct obstacle_text, diameter_m),
    CYAML_FIELD_SEQUENCE_FIXED("edges_m", OPTIONAL, struct obstacle_text, edges_m, &number, 3),
    CYAML_FIELD_BOOL("movable", OPTIONAL, struct obstacle_text, movable),
    CYAML_FIELD_FLOAT("density_kgpm3", OPTIONAL, struct obstacle_text, density_kgpm3),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t obstacle = { CYAML_VALUE_MAPPING(REQUIRED, struct obstacle_text,
                                                                   obstacle_fields) };

const cyaml_schema_field_t dig_bed_fields[] = {
    CYAML_FIELD_SEQUENCE("sizes", OPTIONAL, struct bed_text, sizes, &size, 1, DIG_SIZES_MAX),
    CYAML_FIELD_MAPPING("log_normal", OPTIONAL, struct bed_text, log_normal, log_normal_fields),
    CYAML_FIELD_SEQUENCE("materials", OPTIONAL, struct bed_text, materials, &material, 1,
                         DIG_MATERIALS_MAX),
    CYAML_FIELD_SEQUENCE("pairs", OPTIONAL, struct bed_text, pairs, &pair, 1, DIG_PAIRS_MAX),
    CYAML_FIELD_SEQUENCE("layers", OPTIONAL, struct bed_text, layers, &layer, 1, DIG_LAYERS_MAX),
    CYAML_FIELD_SEQUENCE("surface_m", OPTIONAL, struct bed_text, surface_m, &point, 2,
                         DIG_SURFACE_MAX),
    CYAML_FIELD_SEQUENCE("surfaces", OPTIONAL, struct bed_text, surfaces, &profile, 2,
                         DIG_PROFILES_MAX),
    CYAML_FIELD_SEQUENCE("clump", OPTIONAL, struct bed_text, clump, &sphere, 2, DIG_CLUMP_MAX),
    CYAML_FIELD_SEQUENCE("obstacles", OPTIONAL, struct bed_text, obstacles, &obstacle, 1,
                         DIG_OBSTACLES_MAX),
    CYAML_FIELD_BOOL("periodic_y", OPTIONAL, struct bed_text, periodic_y),
    CYAML_FIELD_FLOAT("preload_Pa", OPTIONAL, struct bed_text, preload_Pa),
    CYAML_FIELD_UINT("earlier_digs", OPTIONAL, struct bed_text, earlier_digs),
    CYAML_FIELD_STRING("earlier", OPTIONAL, struct bed_text, earlier, 1),
    CYAML_FIELD_BOOL("earlier_as_dug", OPTIONAL, struct bed_text, earlier_as_dug),
    SOURCE,
    CYAML_FIELD_END,
};

// The number of the material of that name; one beyond the walls when there is none.
static size_t find_material(const struct dig_bed_plan *const bed, const char *const wanted)
{
    for (size_t k = 0; k <= DIG_MATERIAL_WALLS; k++) {
        if (strcmp(dig_material_name(bed, k), wanted) == 0) {
            return k;
        }
    }
    return DIG_MATERIAL_WALLS + 1;
}

static enum dig_status convert_sizes(const struct bed_text *const text,
                                     struct dig_bed_plan *const bed, struct dig_error *const error)
{
    bed->sizes = text->sizes_count;
    for (size_t i = 0; i < bed->sizes; i++) {
        bed->size[i] = (struct dig_size){ text->sizes[i].diameter_m, text->sizes[i].mass_fraction };
    }
    const struct log_normal_text *const l = &text->log_normal;
    if (l->classes == 0) {
        return DIG_OK;
    }
    if (bed->sizes > 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed.log_normal: beside bed.sizes, expected one of both");
    }
    const enum dig_status status =
        dig_log_normal_classes(l->median_m, l->sigma, l->classes, bed->size);
    if (status != DIG_OK) {
        return dig_error_set(error, status,
                             "bed.log_normal: median_m %g, sigma %g, %u classes, expected > 0, > 0 "
                             "and <= 2, 2 to %d",
                             l->median_m, l->sigma, l->classes, DIG_SIZES_MAX);
    }
    bed->sizes = l->classes;
    return DIG_OK;
}

static void convert_materials(const struct bed_text *const text, struct dig_bed_plan *const bed)
{
    bed->materials = text->materials_count;
    for (size_t i = 0; i < bed->materials; i++) {
        const struct material_text *const m = &text->materials[i];
        bed->material[i]                    = (struct dig_other_material){ .friction      = m->friction,
                                                                           .rolling       = m->rolling,
                                                                           .density_kgpm3 = m->density_kgpm3,
                                                                           .restitution   = m->restitution };
        memcpy(bed->material[i].name, m->name, sizeof m->name);
    }
    bed->pairs = text->pairs_count;
    for (size_t i = 0; i < bed->pairs; i++) {
        const struct pair_text *const p = &text->pairs[i];
        bed->pair[i]                    = (struct dig_material_pair){
                               .a           = find_material(bed, p->between[0].text),
                               .b           = find_material(bed, p->between[1].text),
                               .friction    = p->friction,
                               .rolling     = p->rolling,
                               .restitution = p->restitution,
        };
    }
    bed->layers = text->layers_count;
    for (size_t i = 0; i < bed->layers; i++) {
        const struct layer_text *const l = &text->layers[i];
        bed->layer[i] = (struct dig_layer){ find_material(bed, l->material), l->z_m[0], l->z_m[1] };
    }
}

static enum dig_status convert_obstacles(const struct bed_text *const text,
                                         struct dig_bed_plan *const   bed,
                                         struct dig_error *const      error)
{
    bed->obstacles = text->obstacles_count;
    for (size_t i = 0; i < bed->obstacles; i++) {
        const struct obstacle_text *const o   = &text->obstacles[i];
        struct dig_obstacle *const        to  = &bed->obstacle[i];
        const bool                        box = o->shape == DIG_OBSTACLE_BOX;
        *to               = (struct dig_obstacle){ .shape   = (enum dig_obstacle_shape)o->shape,
                                                   .movable = o->movable };
        to->density_kgpm3 = o->density_kgpm3;
        memcpy(to->centre_m, o->centre_m, sizeof to->centre_m);
        if (box) {
            memcpy(to->size_m, o->edges_m, sizeof to->size_m);
        } else {
            to->size_m[0] = o->diameter_m;
        }
        if (box ? o->diameter_m > 0.0 : o->edges_m[0] > 0.0) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed.obstacles[%zu].%s: expected only %s for a %s", i,
                                 box ? "diameter_m" : "edges_m", box ? "edges_m" : "diameter_m",
                                 box ? "box" : "sphere");
        }
    }
    return DIG_OK;
}

static void convert_profiles(const struct bed_text *const text, struct dig_bed_plan *const bed)
{
    bed->profiles = text->surfaces_count;
    for (size_t k = 0; k < bed->profiles; k++) {
        const struct profile_text *const p = &text->surfaces[k];
        bed->profile[k] =
            (struct dig_ground_profile){ .y_m = p->y_m, .points = p->surface_m_count };
        for (size_t i = 0; i < p->surface_m_count; i++) {
            bed->profile[k].x_m[i] = p->surface_m[i].xz_m[0];
            bed->profile[k].z_m[i] = p->surface_m[i].xz_m[1];
        }
    }
}

enum dig_status dig_bed_convert(const struct laws_text *const laws,
                                const struct bed_text *const text, struct dig_scene *const scene,
                                struct dig_error *const error)
{
    struct dig_bed_plan *const bed = &scene->bed;
    scene->laws                    = (struct dig_laws){ .normal            = (enum dig_normal_law)laws->normal,
                                                        .rolling           = (enum dig_rolling_law)laws->rolling,
                                                        .cohesion_Jpm3     = laws->cohesion_Jpm3,
                                                        .adhesion_Jpm3     = laws->adhesion_Jpm3,
                                                        .bucket_smoothness = laws->bucket_smoothness };
    *bed                           = (struct dig_bed_plan){ .surface        = text->surface_m_count,
                                                            .clump.spheres  = text->clump_count,
                                                            .periodic_y     = text->periodic_y,
                                                            .preload_Pa     = text->preload_Pa,
                                                            .earlier_digs   = text->earlier_digs,
                                                            .earlier_as_dug = text->earlier_as_dug };
    memcpy(bed->earlier, text->earlier, sizeof bed->earlier);
    for (size_t i = 0; i < bed->surface; i++) {
        bed->surface_x_m[i] = text->surface_m[i].xz_m[0];
        bed->surface_z_m[i] = text->surface_m[i].xz_m[1];
    }
    convert_profiles(text, bed);
    for (size_t i = 0; i < bed->clump.spheres; i++) {
        bed->clump.x[i]      = text->clump[i].centre[0];
        bed->clump.y[i]      = text->clump[i].centre[1];
        bed->clump.z[i]      = text->clump[i].centre[2];
        bed->clump.radius[i] = text->clump[i].radius;
    }
    enum dig_status status = convert_sizes(text, bed, error);
    convert_materials(text, bed);
    return status == DIG_OK ? convert_obstacles(text, bed, error) : status;
}
