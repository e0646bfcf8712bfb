// Rocks in the bed: spheres and boxes with the contact law of a wall.

#ifndef DIG_OFFLINE_DEM_WORLD_OBSTACLES_H
#define DIG_OFFLINE_DEM_WORLD_OBSTACLES_H

#include "core/bed.h"
#include "core/scene.h"
#include "offline_dem/shapes/rock_surface.h"
#include "offline_dem/world/world.h"

/// A rock: its surface, its motion, and the load of the grains in the last step.
struct dig_rock {
    struct dig_rock_surface surface;
    bool                    movable;
    double                  mass_kg; // 0: fixed
    double                  v_mps[3], w_radps[3];
    struct dig_wrench       load; // about its centre
};

struct dig_obstacles {
    size_t          rocks;
    struct dig_rock rock[DIG_OBSTACLES_MAX];

    // Pose of each rock at the last contact detection, and the displacement of its surface that
    // these contacts cover.
    struct dig_rock_surface reference[DIG_OBSTACLES_MAX];
    double                  margin_m[DIG_OBSTACLES_MAX];
};

/// The scene's obstacles where the scene has them.
struct dig_obstacles dig_obstacles_make(const struct dig_scene *scene);

/// Copies the rocks' poses from the bed, and to it.
void dig_obstacles_load_poses(struct dig_obstacles *obstacles, const struct dig_bed *bed);
void dig_obstacles_save_poses(const struct dig_obstacles *obstacles, struct dig_bed *bed);

/// Half its smallest edge, or its radius.
double dig_rock_least_half_m(const struct dig_rock_surface *rock);

/// Before contact detection: what displacement of the rocks it has to cover.
void dig_obstacles_set_margins(struct dig_obstacles *obstacles, double dt_s);

/// Whether a rock, in any image, may come within reach_m of a grain at x_m before the next
/// detection.
bool dig_obstacles_is_near(const struct dig_obstacles *obstacles, const struct dig_world *world,
                           size_t rock, const double x_m[], double reach_m);

/// Whether a rock has left its margin: contacts with it may be missing.
bool dig_obstacles_left_margin(const struct dig_obstacles *obstacles);

/// Of a grain's nearest image and the rock's closest point to it: their distance d_m, the arm from
/// the rock's centre to that point and its velocity.
void dig_obstacles_separation(const struct dig_world *world, const struct dig_rock *rock,
                              const double x_m[], double radius_m, double d_m[3], double arm_m[3],
                              double v_mps[3]);

#endif // DIG_OFFLINE_DEM_WORLD_OBSTACLES_H
