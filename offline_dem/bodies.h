// Bodies among the grains: clumps of spheres that move as one, and obstacles. The world calls these
// once a step, in this order; all of them do nothing for a world without bodies.

#ifndef DIG_OFFLINE_DEM_BODIES_H
#define DIG_OFFLINE_DEM_BODIES_H

#include "core/status.h"
#include "offline_dem/world.h"

#include <stdint.h>

struct dig_bodies;

/// After the contact lists were remade: which grains may touch which obstacle. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_bodies_pick(struct dig_world *world);

/// After the loads of pairs, walls and tool: adds those of obstacles, gathers the loads of the
/// members of every clump and sets the members' velocities.
void dig_bodies_push(struct dig_world *world);

/// After the grains have moved.
void dig_bodies_advance(struct dig_world *world);

/// Grains change places: place[old index] is the new one, UINT32_MAX: gone. NULL bodies: nothing.
void dig_bodies_move(struct dig_bodies *bodies, const uint32_t place[]);

#endif // DIG_OFFLINE_DEM_BODIES_H
