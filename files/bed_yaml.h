// The optional parts of a scene YAML: `laws` and `bed`, as they are written. files/scene_yaml.c
// puts their fields into its schema.

#ifndef DIG_FILES_BED_YAML_H
#define DIG_FILES_BED_YAML_H

#include "core/error.h"
#include "core/scene.h"

#include <cyaml/cyaml.h>
#include <stdint.h>

struct laws_text {
    int    normal, rolling; // enum dig_normal_law, enum dig_rolling_law
    double cohesion_Jpm3, adhesion_Jpm3, bucket_smoothness;
};

struct size_text {
    double diameter_m, mass_fraction;
};

struct log_normal_text {
    double   median_m, sigma;
    uint32_t classes;
};

struct material_text {
    char   name[DIG_NAME_SIZE];
    double friction, rolling, density_kgpm3, restitution;
};

struct name_text {
    char text[DIG_NAME_SIZE];
};

struct pair_text {
    struct name_text between[2];
    double           friction, rolling, restitution;
};

struct layer_text {
    char   material[DIG_NAME_SIZE];
    double z_m[2];
};

struct surface_text {
    double xz_m[2];
};

struct profile_text {
    double              y_m;
    struct surface_text surface_m[DIG_SURFACE_MAX];
    uint32_t            surface_m_count;
};

struct sphere_text {
    double centre[3];
    double radius;
};

struct obstacle_text {
    int    shape; // enum dig_obstacle_shape
    double centre_m[3];
    double diameter_m;
    double edges_m[3];
    bool   movable;
    double density_kgpm3;
};

struct bed_text {
    struct size_text       sizes[DIG_SIZES_MAX];
    struct log_normal_text log_normal;
    struct material_text   materials[DIG_MATERIALS_MAX];
    struct pair_text       pairs[DIG_PAIRS_MAX];
    struct layer_text      layers[DIG_LAYERS_MAX];
    struct surface_text    surface_m[DIG_SURFACE_MAX];
    struct profile_text    surfaces[DIG_PROFILES_MAX];
    struct sphere_text     clump[DIG_CLUMP_MAX];
    struct obstacle_text   obstacles[DIG_OBSTACLES_MAX];
    double                 preload_Pa;
    char                   earlier[DIG_NAME_SIZE];
    // How many of the lists above, in their order.
    uint32_t sizes_count, materials_count, pairs_count, layers_count, surface_m_count,
        surfaces_count, clump_count, obstacles_count;
    uint32_t earlier_digs;
    bool     periodic_y, earlier_as_dug;
};

extern const cyaml_schema_field_t dig_laws_fields[];
extern const cyaml_schema_field_t dig_bed_fields[];

/// Into the scene's laws and bed. DIG_EINVAL names the key of a material that is not there, of an
/// obstacle whose size does not fit its shape, or of a distribution that cannot be.
DIG_MUST_CHECK enum dig_status dig_bed_convert(const struct laws_text *laws,
                                               const struct bed_text *bed, struct dig_scene *scene,
                                               struct dig_error *error);

#endif // DIG_FILES_BED_YAML_H
