// The optional parts of a scene YAML: `laws` and `bed`, as they are written. files/scene_yaml.c
// puts their fields into its schema.

#ifndef DIG_FILES_BED_YAML_H
#define DIG_FILES_BED_YAML_H

#include "core/error.h"
#include "core/scene.h"
#include "files/yaml/yaml_schema.h"

#include <stdint.h>

struct pair_text {
    char   between[2][DIG_NAME_SIZE]; // materials
    double friction, rolling, restitution;
};

struct layer_text {
    char   material[DIG_NAME_SIZE];
    double z_m[2];
};

struct profile_text {
    double                y_m;
    struct dig_yaml_point surface_m[DIG_SURFACE_MAX];
    size_t                points;
};

struct sphere_text {
    double centre[3];
    double radius;
};

struct obstacle_text {
    struct dig_obstacle obstacle;
    double              diameter_m;
    double              edges_m[3];
};

/// A bed, beside the lists that name materials, or that it keeps in another order.
struct bed_text {
    struct dig_bed_plan   bed;
    double                median_m, sigma; // of a log-normal distribution
    uint32_t              classes;
    struct pair_text      pairs[DIG_PAIRS_MAX];
    struct layer_text     layers[DIG_LAYERS_MAX];
    struct dig_yaml_point surface_m[DIG_SURFACE_MAX];
    struct profile_text   surfaces[DIG_PROFILES_MAX];
    struct sphere_text    clump[DIG_CLUMP_MAX];
    struct obstacle_text  obstacles[DIG_OBSTACLES_MAX];
};

extern const struct dig_yaml_field dig_laws_fields[]; // into a struct dig_laws
extern const struct dig_yaml_field dig_bed_fields[];  // into a struct bed_text

/// Points of a polyline into two arrays.
void dig_bed_polyline(size_t points, const struct dig_yaml_point text[], double x_m[],
                      double z_m[]);

/// The whole bed. DIG_EINVAL names the key of a material that is not there, of an obstacle whose
/// size does not fit its shape, or of a distribution that cannot be.
DIG_MUST_CHECK enum dig_status dig_bed_convert(const struct bed_text *text,
                                               struct dig_bed_plan *bed, struct dig_error *error);

#endif // DIG_FILES_BED_YAML_H
