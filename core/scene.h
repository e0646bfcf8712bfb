// The scene of a dig: bucket, bed box, contact law and trajectories. files/scene_yaml.h reads it,
// offline_dem/ computes in it, every table names it by its hash.
// World frame and signs: core/curve.h.

#ifndef DIG_CORE_SCENE_H
#define DIG_CORE_SCENE_H

#include "core/curve.h"
#include "core/error.h"
#include "core/status.h"

#include <stdbool.h>

#define DIG_PROFILE_MAX   16
#define DIG_SIZES_MAX     8  // classes of grain size
#define DIG_MATERIALS_MAX 4  // materials of grains beside the table's gravel
#define DIG_PAIRS_MAX     16 // two of DIG_MATERIALS_MAX, in either order
#define DIG_LAYERS_MAX    4
#define DIG_SURFACE_MAX   16 // points of the ground's profile
#define DIG_PROFILES_MAX  8  // of them across the bed
#define DIG_CLUMP_MAX     8  // spheres of a clump
#define DIG_OBSTACLES_MAX 8
#define DIG_EARLIER_MAX   20

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

/// The contact laws to choose from; the first of each is the default.
enum dig_normal_law { DIG_NORMAL_HOOKE, DIG_NORMAL_HERTZ };
enum dig_rolling_law { DIG_ROLLING_EPSD2, DIG_ROLLING_CDT, DIG_ROLLING_NONE };

struct dig_material {
    double diameter_m;
    double young_Pa;
    double poisson;
    double restitution;
    double characteristic_velocity_mps;
    // The density that young_Pa belongs to; a gravel of another has it in proportion, so that
    // curves go with the density (docs/numerics/dem.md, "Density is a scale"). 0: young_Pa holds
    // for all.
    double young_at_kgpm3;
};

/// Which laws hold in the scene.
struct dig_laws {
    enum dig_normal_law  normal;
    enum dig_rolling_law rolling;
    double               cohesion_Jpm3; // SJKR between grains; 0: none
    double               adhesion_Jpm3; // SJKR between grains and bucket; 0: none
    // Share that is taken off friction and rolling friction of grains with the bucket, be they the
    // grains' own or a pair's; 0: none, 1: a bucket without friction.
    double bucket_smoothness;
};

/// A class of grain size. A log-normal distribution is read into classes of equal mass.
struct dig_size {
    double diameter_m;
    double mass_fraction;
};

/// A material of grains with values of its own, where the table's gravel has the grid's.
struct dig_other_material {
    char   name[DIG_NAME_SIZE];
    double friction, rolling, density_kgpm3, restitution;
};

#define DIG_MATERIAL_BUCKET (DIG_MATERIALS_MAX + 1)
#define DIG_MATERIAL_WALLS  (DIG_MATERIALS_MAX + 2)

/// Contact constants of two materials, where they are not the smaller friction and rolling friction
/// and the geometric mean of restitution of both. Material 0 is the gravel, 1 … the others,
/// DIG_MATERIAL_BUCKET and DIG_MATERIAL_WALLS.
struct dig_material_pair {
    size_t a, b;
    double friction, rolling, restitution;
};

/// Grains whose centre lies between these heights, when the bed has settled and before it is
/// levelled, are of the material; where layers overlap, of the later one's.
struct dig_layer {
    size_t material; // as above
    double from_m, to_m;
};

/// The shape of grains made of several overlapping spheres, in any unit of length: it is scaled to
/// the volume of the sphere whose diameter the grain is given. No spheres: grains are spheres.
struct dig_clump {
    size_t spheres;
    double x[DIG_CLUMP_MAX], y[DIG_CLUMP_MAX], z[DIG_CLUMP_MAX], radius[DIG_CLUMP_MAX];
};

enum dig_obstacle_shape { DIG_OBSTACLE_SPHERE, DIG_OBSTACLE_BOX };

/// A rock in the bed: fixed, or moved by the grains, the bucket and the walls.
struct dig_obstacle {
    enum dig_obstacle_shape shape;
    double                  centre_m[3];
    double                  size_m[3]; // sphere: diameter in size_m[0]; box: edges
    bool                    movable;
    double                  density_kgpm3;
};

/// The ground along x at one y, of a ground that is not the same across the bed.
struct dig_ground_profile {
    double y_m;
    size_t points;
    double x_m[DIG_SURFACE_MAX], z_m[DIG_SURFACE_MAX];
};

/// What makes a scene more than one kind of equal spheres in a flat bed. All zero: plain.
struct dig_bed_plan {
    size_t                    sizes;
    struct dig_size           size[DIG_SIZES_MAX]; // 0: all material.diameter_m
    size_t                    materials;
    struct dig_other_material material[DIG_MATERIALS_MAX];
    size_t                    pairs;
    struct dig_material_pair  pair[DIG_PAIRS_MAX];
    size_t                    layers;
    struct dig_layer          layer[DIG_LAYERS_MAX]; // none: all gravel
    size_t                    surface;               // the ground's profile, 0: flat at box.z_max_m
    double                    surface_x_m[DIG_SURFACE_MAX], surface_z_m[DIG_SURFACE_MAX];
    size_t                    profiles; // in place of surface where the ground differs across y
    struct dig_ground_profile profile[DIG_PROFILES_MAX]; // y ascending
    struct dig_clump          clump;
    size_t                    obstacles;
    struct dig_obstacle       obstacle[DIG_OBSTACLES_MAX];
    bool                      periodic_y; // no walls in y
    double                    preload_Pa; // a plate that compacts the bed before levelling; 0: none
    size_t                    earlier_digs; // made in the same bed before the one that counts
    char                      earlier[DIG_NAME_SIZE]; // their trajectory; "": the same
    bool                      earlier_as_dug; // the bed is left so; false: it is levelled again
};

struct dig_scene {
    char                  name[DIG_NAME_SIZE];
    struct dig_bucket     bucket;
    struct dig_box        box;
    struct dig_packing    packing;
    struct dig_material   material;
    struct dig_laws       laws;
    struct dig_bed_plan   bed;
    double                gravity_mps2;
    double                time_step_s; // 0: derived from the contact and Rayleigh times
    double                output_s;    // width of the averaging window of a curve, 0.005
    size_t                trajectories;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX];
    bool                  may_tremble; // a step that heats is not refused; no part of the identity
};

/// Bucket pin to tooth, m.
double dig_scene_tooth_m(const struct dig_scene *scene);

/// The length after which y repeats, 0 where the box has sides.
double dig_scene_period_m(const struct dig_scene *scene);

/// Young's modulus of a gravel of this density.
double dig_scene_young_Pa(const struct dig_scene *scene, double density_kgpm3);

/// Contact constants of gravel and bucket; NULL: the bucket is as rough as each gravel.
const struct dig_material_pair *dig_scene_bucket_pair(const struct dig_scene *scene);

/// The trajectory of that name, or NULL.
const struct dig_trajectory *dig_scene_find(const struct dig_scene *scene, const char *name);

/// Refuses what cannot be computed; *error names the key as it stands in the YAML and what was
/// expected ("material.young_Pa: -1, expected > 0").
DIG_MUST_CHECK enum dig_status dig_scene_check(const struct dig_scene *scene,
                                               struct dig_error       *error);

#define DIG_SCENE_TEXT_SIZE 32768 // a scene of everything, in its longest numbers, needs 25844

/// Writes the canonical text the scene's identity is the SHA-256 of: every field that changes a
/// curve, numbers as %.17g, one `key=value` a line.
void dig_scene_canonical(const struct dig_scene *scene, char text[DIG_SCENE_TEXT_SIZE]);

/// The scene's identity: lower-case hex SHA-256 of its canonical text.
void dig_scene_hash(const struct dig_scene *scene, char hex[65]);

#endif // DIG_CORE_SCENE_H
