// Keeps an world's contact lists right: made anew when a grain or the tool has left its margin,
// with every contact that goes on remembering what it knew.

#ifndef DIG_OFFLINE_DEM_WORLD_LISTS_H
#define DIG_OFFLINE_DEM_WORLD_LISTS_H

#include "offline_dem/world/world.h"

/// Remakes the contact lists, and the neighbour list behind them if it no longer covers the
/// margins. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_lists_update(struct dig_world *world);

/// How far a grain may move before the neighbour list is made anew: so many of its radii and steps
/// of its speed, and no more than so many radii.
struct dig_skin {
    double radii, steps, most_radii;
};

/// Sorts the grains along cells and remakes the neighbour list. Contacts in the lists follow: their
/// key is their place in the neighbour list, or UINT32_MAX, and pairs of one kind are turned to
/// stand as they stand there. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_lists_rebuild(struct dig_world *world, struct dig_skin skin);

/// Follows grains to new places: place[old index] is the new one, UINT32_MAX: gone.
void dig_lists_renumber(struct dig_world *world, const uint32_t new_index[]);

void dig_lists_finish(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_WORLD_LISTS_H
