// Contacts of grains with walls, the tool's plates and rocks over one step. Which plates are
// contacts: offline_dem/shapes/plate_contacts.h.

#ifndef DIG_OFFLINE_DEM_WORLD_SURFACES_H
#define DIG_OFFLINE_DEM_WORLD_SURFACES_H

#include "offline_dem/world/world.h"

/// Adds the loads of walls and tool to the grains of a slab, and what they feel to on_tool and
/// on_walls.
void dig_surfaces_add_loads(struct dig_world *world, size_t slab, struct dig_wrench *on_tool,
                            struct dig_wrench *on_walls);

/// Adds the loads of the rocks to the grains, and what each rock feels to its load. The world has
/// bodies.
void dig_surfaces_add_rock_loads(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_WORLD_SURFACES_H
