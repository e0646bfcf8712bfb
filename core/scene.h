// What is dug, with what, and how: bucket, bed box, law and trajectories. Read from a scene YAML by
// files/scene_yaml.h, computed in by offline_dem/, named by its hash in every table.
// World frame and signs: core/curve.h.

#ifndef DIG_CORE_SCENE_H
#define DIG_CORE_SCENE_H

#include "core/curve.h"
#include "core/error.h"
#include "core/status.h"

#define DIG_PROFILE_MAX 16

/// The bucket: plates of zero thickness over the width along the profile's polyline, two side
/// plates that close the profile's polygon at +-width/2, mouth open between last and first point.
struct dig_bucket {
    size_t points;
    double x_m[DIG_PROFILE_MAX]; // body frame, first point is the tooth
    double z_m[DIG_PROFILE_MAX];
    double width_m;
};

/// The bed: a box with frictional walls, open at the top, levelled at z_max.
struct dig_box {
    double x_min_m, x_max_m, y_min_m, y_max_m, z_min_m, z_max_m;
};

/// The pouring that makes a bed: grains at random without overlap, at this solid fraction, falling.
struct dig_packing {
    double solid_fraction; // of the region they are dropped in
    double fill_factor;    // volume of grains poured / volume of the levelled box, before levelling
    double fall_mps;       // initial speed downwards
    double settle_s;       // before levelling
    double relax_s;        // after levelling
};

struct dig_material {
    double diameter_m;
    double young_Pa;
    double poisson;
    double restitution;
    double characteristic_velocity_mps;
};

struct dig_scene {
    char                  name[DIG_NAME_SIZE];
    struct dig_bucket     bucket;
    struct dig_box        box;
    struct dig_packing    packing;
    struct dig_material   material;
    double                gravity_mps2;
    double                time_step_s; // 0: derived from the contact and Rayleigh times
    double                output_s;    // width of the averaging window of a curve, 0.005
    size_t                trajectories;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX];
};

/// Bucket pin to tooth, m.
double dig_scene_tooth_m(const struct dig_scene *scene);

/// The trajectory of that name, or NULL.
const struct dig_trajectory *dig_scene_find(const struct dig_scene *scene, const char *name);

/// Refuses what cannot be computed; *error names the key as it stands in the YAML and what was
/// expected ("material.young_Pa: -1, expected > 0").
DIG_MUST_CHECK enum dig_status dig_scene_check(const struct dig_scene *scene,
                                               struct dig_error       *error);

/// Writes the canonical text the scene's identity is the SHA-256 of: every field that changes a
/// curve, numbers as %.17g, one `key=value` a line. Returns the length it needs, as snprintf does.
size_t dig_scene_canonical(const struct dig_scene *scene, size_t size, char text[]);

#endif // DIG_CORE_SCENE_H
