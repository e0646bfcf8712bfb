// Bodies among the grains: rigid clumps of spheres, and obstacles. The world calls these functions
// once a step, in this order. They do nothing for a world without bodies.

#ifndef DIG_OFFLINE_DEM_WORLD_BODIES_H
#define DIG_OFFLINE_DEM_WORLD_BODIES_H

#include "core/bed.h"
#include "core/scene.h"
#include "core/status.h"
#include "offline_dem/kernel/clump_body.h"
#include "offline_dem/world/obstacles.h"
#include "offline_dem/world/ode_rocks.h"
#include "offline_dem/world/world.h"

#include <stdint.h>

struct dig_bodies {
    struct dig_clump_shape shape;
    size_t                 clumps;
    struct dig_clump_body *clump; // [clumps]
    struct dig_obstacles   obstacles;
    struct dig_ode_scene  *ode; // moves the rocks; NULL: all are fixed
    struct dig_law         rock_law[DIG_OBSTACLES_MAX];
};

/// Bodies of a bed whose grain i has index i in the world, each clump falling at fall_mps;
/// clump_kg[type] is the mass of the clump of a grain of that type. Allocates and fills
/// grains->clump. *bodies is NULL where there are none. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_bodies_create(const struct dig_scene *scene, const struct dig_bed *bed,
                  const struct dig_clump_shape *shape, const double clump_kg[], double fall_mps,
                  struct dig_grains *grains, struct dig_bodies **bodies);

/// NULL is allowed.
void dig_bodies_destroy(struct dig_bodies *bodies);

/// Rocks among them. NULL: 0.
static inline size_t dig_bodies_rocks(const struct dig_bodies *const bodies)
{
    return bodies != NULL ? bodies->obstacles.rocks : 0;
}

/// Adds the loads of obstacles, steps every clump under the loads of its spheres, and sets their
/// velocities so that the kernel moves them with the clump. After the loads of pairs, walls and
/// tool.
void dig_bodies_apply_loads(struct dig_world *world);

/// From now on this ODE scene, which must outlive the bodies, moves the rocks that are not fixed.
/// Their contacts with walls, bucket and each other follow this material's law.
void dig_bodies_release_rocks(struct dig_bodies *bodies, struct dig_ode_scene *ode,
                              const struct dig_law_material *material);

/// Steps the rocks, after the grains have moved.
void dig_bodies_step_rocks(struct dig_world *world);

/// Maps grains to their new indices: new_index[old], UINT32_MAX: removed. NULL bodies: nothing.
void dig_bodies_renumber(struct dig_bodies *bodies, const uint32_t new_index[]);

#endif // DIG_OFFLINE_DEM_WORLD_BODIES_H
