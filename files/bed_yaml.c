#include "files/bed_yaml.h"

#include "core/bed_plan.h"
#include "core/log_normal.h"

#include <string.h>

static const struct dig_yaml_word normal_laws[] = {
    { "hooke", DIG_NORMAL_HOOKE },
    { "hertz", DIG_NORMAL_HERTZ },
    { .word = NULL },
};
static const struct dig_yaml_word rolling_laws[] = {
    { "epsd2", DIG_ROLLING_EPSD2 },
    { "cdt", DIG_ROLLING_CDT },
    { "none", DIG_ROLLING_NONE },
    { .word = NULL },
};
static const struct dig_yaml_word shapes[] = {
    { "sphere", DIG_OBSTACLE_SPHERE },
    { "box", DIG_OBSTACLE_BOX },
    { .word = NULL },
};

const struct dig_yaml_field dig_laws_fields[] = {
    FIELD(WORD, "normal", dig_laws, normal, OPTIONAL, .word = normal_laws),
    FIELD(WORD, "rolling", dig_laws, rolling, OPTIONAL, .word = rolling_laws),
    FIELD(NUMBER, "cohesion_Jpm3", dig_laws, cohesion_Jpm3, OPTIONAL),
    FIELD(NUMBER, "adhesion_Jpm3", dig_laws, adhesion_Jpm3, OPTIONAL),
    FIELD(NUMBER, "bucket_smoothness", dig_laws, bucket_smoothness, OPTIONAL),
    SOURCE,
    END,
};

static const struct dig_yaml_field size_fields[] = {
    NUMBER(dig_size, diameter_m),
    NUMBER(dig_size, mass_fraction),
    END,
};
static const struct dig_yaml_field size = ENTRY(dig_size, size_fields);

static const struct dig_yaml_field log_normal_fields[] = {
    NUMBER(bed_text, median_m),
    NUMBER(bed_text, sigma),
    FIELD(COUNT, "classes", bed_text, classes, REQUIRED),
    END,
};

static const struct dig_yaml_field material_fields[] = {
    TEXT(dig_other_material, name),
    NUMBER(dig_other_material, friction),
    NUMBER(dig_other_material, rolling),
    NUMBER(dig_other_material, density_kgpm3),
    NUMBER(dig_other_material, restitution),
    SOURCE,
    END,
};
static const struct dig_yaml_field material = ENTRY(dig_other_material, material_fields);

static const struct dig_yaml_field pair_fields[] = {
    FIELD(LIST, "between", pair_text, between, REQUIRED, .of = &dig_yaml_name),
    NUMBER(pair_text, friction),
    NUMBER(pair_text, rolling),
    NUMBER(pair_text, restitution),
    SOURCE,
    END,
};
static const struct dig_yaml_field pair = ENTRY(pair_text, pair_fields);

static const struct dig_yaml_field layer_fields[] = {
    TEXT(layer_text, material),
    NUMBERS("z_m", REQUIRED, layer_text, z_m),
    END,
};
static const struct dig_yaml_field layer = ENTRY(layer_text, layer_fields);

static const struct dig_yaml_field profile_fields[] = {
    NUMBER(profile_text, y_m),
    LIST("surface_m", REQUIRED, profile_text, surface_m, points, &dig_yaml_point, 2),
    END,
};
static const struct dig_yaml_field profile = ENTRY(profile_text, profile_fields);

static const struct dig_yaml_field sphere_fields[] = {
    NUMBERS("centre", REQUIRED, sphere_text, centre),
    NUMBER(sphere_text, radius),
    END,
};
static const struct dig_yaml_field sphere = ENTRY(sphere_text, sphere_fields);

static const struct dig_yaml_field obstacle_fields[] = {
    FIELD(WORD, "shape", obstacle_text, obstacle.shape, REQUIRED, .word = shapes),
    NUMBERS("centre_m", REQUIRED, obstacle_text, obstacle.centre_m),
    FIELD(NUMBER, "diameter_m", obstacle_text, diameter_m, OPTIONAL),
    NUMBERS("edges_m", OPTIONAL, obstacle_text, edges_m),
    FIELD(BOOL, "movable", obstacle_text, obstacle.movable, OPTIONAL),
    FIELD(NUMBER, "density_kgpm3", obstacle_text, obstacle.density_kgpm3, OPTIONAL),
    SOURCE,
    END,
};
static const struct dig_yaml_field obstacle = ENTRY(obstacle_text, obstacle_fields);

#define OF_BED(key, member, count, entry, least)                                                   \
    LIST(key, OPTIONAL, bed_text, member, bed.count, entry, least)

const struct dig_yaml_field dig_bed_fields[] = {
    OF_BED("sizes", bed.size, sizes, &size, 1),
    ACROSS("log_normal", OPTIONAL, log_normal_fields),
    OF_BED("materials", bed.material, materials, &material, 1),
    OF_BED("pairs", pairs, pairs, &pair, 1),
    OF_BED("layers", layers, layers, &layer, 1),
    OF_BED("surface_m", surface_m, surface, &dig_yaml_point, 2),
    OF_BED("surfaces", surfaces, profiles, &profile, 2),
    OF_BED("clump", clump, clump.spheres, &sphere, 2),
    OF_BED("obstacles", obstacles, obstacles, &obstacle, 1),
    FIELD(BOOL, "periodic_y", bed_text, bed.periodic_y, OPTIONAL),
    FIELD(NUMBER, "preload_Pa", bed_text, bed.preload_Pa, OPTIONAL),
    FIELD(COUNT, "earlier_digs", bed_text, bed.earlier_digs, OPTIONAL),
    FIELD(TEXT, "earlier", bed_text, bed.earlier, OPTIONAL, .least = 1),
    FIELD(BOOL, "earlier_as_dug", bed_text, bed.earlier_as_dug, OPTIONAL),
    SOURCE,
    END,
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
    if (text->classes == 0) {
        return DIG_OK;
    }
    if (bed->sizes > 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed.log_normal: beside bed.sizes, expected one of both");
    }
    const enum dig_status status =
        dig_log_normal_classes(text->median_m, text->sigma, text->classes, bed->size);
    if (status != DIG_OK) {
        return dig_error_set(error, status,
                             "bed.log_normal: median_m %g, sigma %g, %u classes, expected > 0, > 0 "
                             "and <= 2, 2 to %d",
                             text->median_m, text->sigma, text->classes, DIG_SIZES_MAX);
    }
    bed->sizes = text->classes;
    return DIG_OK;
}

static void convert_materials(const struct bed_text *const text, struct dig_bed_plan *const bed)
{
    for (size_t i = 0; i < bed->pairs; i++) {
        const struct pair_text *const p = &text->pairs[i];
        bed->pair[i]                    = (struct dig_material_pair){
                               .a           = find_material(bed, p->between[0]),
                               .b           = find_material(bed, p->between[1]),
                               .friction    = p->friction,
                               .rolling     = p->rolling,
                               .restitution = p->restitution,
        };
    }
    for (size_t i = 0; i < bed->layers; i++) {
        const struct layer_text *const l = &text->layers[i];
        bed->layer[i] = (struct dig_layer){ find_material(bed, l->material), l->z_m[0], l->z_m[1] };
    }
}

static enum dig_status convert_obstacles(const struct bed_text *const text,
                                         struct dig_bed_plan *const   bed,
                                         struct dig_error *const      error)
{
    for (size_t i = 0; i < bed->obstacles; i++) {
        const struct obstacle_text *const o  = &text->obstacles[i];
        struct dig_obstacle *const        to = &bed->obstacle[i];
        *to                                  = o->obstacle;
        const bool box                       = to->shape == DIG_OBSTACLE_BOX;
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

void dig_bed_polyline(const size_t points, const struct dig_yaml_point text[], double x_m[],
                      double z_m[])
{
    for (size_t i = 0; i < points; i++) {
        x_m[i] = text[i].xz_m[0];
        z_m[i] = text[i].xz_m[1];
    }
}

enum dig_status dig_bed_convert(const struct bed_text *const text, struct dig_bed_plan *const bed,
                                struct dig_error *const error)
{
    *bed = text->bed;
    dig_bed_polyline(bed->surface, text->surface_m, bed->surface_x_m, bed->surface_z_m);
    for (size_t k = 0; k < bed->profiles; k++) {
        const struct profile_text *const p  = &text->surfaces[k];
        struct dig_ground_profile *const to = &bed->profile[k];
        to->y_m                             = p->y_m;
        to->points                          = p->points;
        dig_bed_polyline(p->points, p->surface_m, to->x_m, to->z_m);
    }
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
