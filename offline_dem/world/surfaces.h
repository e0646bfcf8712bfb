// Contacts of grains with walls and with the tool's plates over one step.
//
// Plates share edges. A grain touches the tool where its distance to all plates together has a
// local minimum: a plate's edge counts only if the neighbouring plate comes no closer there, and an
// edge two plates share is one contact. In a concave corner a grain lies on two faces: two
// contacts. A contact that passes over an edge from plate to plate keeps its history.

#ifndef DIG_OFFLINE_DEM_WORLD_SURFACES_H
#define DIG_OFFLINE_DEM_WORLD_SURFACES_H

#include "offline_dem/world/world.h"

/// Adds the loads of walls and tool to the grains, and fills on_tool and on_walls.
void dig_surfaces_add_loads(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_WORLD_SURFACES_H
