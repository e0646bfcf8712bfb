// Bodies among the grains: clumps of spheres that move as one, and obstacles. The world calls these
// once a step, in this order; all of them do nothing for a world without bodies.

#ifndef DIG_OFFLINE_DEM_WORLD_BODIES_H
#define DIG_OFFLINE_DEM_WORLD_BODIES_H

#include "core/scene.h"
#include "core/status.h"
#include "offline_dem/kernel/bed.h"
#include "offline_dem/kernel/clump_body.h"
#include "offline_dem/world/obstacles.h"
#include "offline_dem/world/ode_rocks.h"
#include "offline_dem/world/world.h"

#include <stdint.h>

struct dig_bodies {
    struct dig_clump_shape      shape;
    size_t                      clumps;
    struct dig_clump_body      *clump; // [clumps]
    struct dig_obstacles        obstacles;
    struct dig_ode_scene       *ode; // moves the rocks; NULL: all are fixed
    struct dig_rock_contact_law rock_law[DIG_OBSTACLES_MAX];
};

/// Bodies for a bed whose grain i stands at place i of the world's grains, each clump falling at
/// fall_mps; body_kg[grain] is the mass of the clump it belongs to. Numbers the grains of clumps
/// (grains->clump is allocated). *bodies is NULL where there are none. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_bodies_create(const struct dig_scene *scene, const struct dig_bed *bed,
                  const struct dig_clump_shape *shape, const double body_kg[], double fall_mps,
                  struct dig_grains *grains, struct dig_bodies **bodies);

/// NULL is allowed.
void dig_bodies_destroy(struct dig_bodies *bodies);

/// After the contact lists were remade: which grains may touch which obstacle. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_bodies_detect(struct dig_world *world);

/// After the loads of pairs, walls and tool: adds those of obstacles, gathers the loads of the
/// members of every clump, steps the clumps and sets the members' velocities so that the kernel
/// moves them to where the clump has gone.
void dig_bodies_apply_loads(struct dig_world *world);

/// Rocks that are not fixed are moved by this ODE scene from now on, which must outlive the bodies;
/// they touch walls, bucket and each other by this material's law.
void dig_bodies_release_rocks(struct dig_bodies *bodies, struct dig_ode_scene *ode,
                              const struct dig_law_material *material);

/// After the grains have moved: the rocks do.
void dig_bodies_step_rocks(struct dig_world *world);

/// Grains change places: place[old index] is the new one, UINT32_MAX: gone. NULL bodies: nothing.
void dig_bodies_renumber(struct dig_bodies *bodies, const uint32_t new_index[]);

#endif // DIG_OFFLINE_DEM_WORLD_BODIES_H
