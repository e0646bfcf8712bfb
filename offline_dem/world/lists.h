// Keeps a world's contact lists valid: rebuilt when a grain or the tool has left its margin.
// Contacts that go on keep their history.

#ifndef DIG_OFFLINE_DEM_WORLD_LISTS_H
#define DIG_OFFLINE_DEM_WORLD_LISTS_H

#include "offline_dem/world/world.h"

/// Remakes the contact lists, and the neighbour list if it no longer covers the margins.
/// DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_lists_update(struct dig_world *world);

/// Verlet skin: displacement of a grain at which the neighbour list is rebuilt, in its radii and in
/// steps at its speed, at most so many radii.
struct dig_skin {
    double radii, steps, most_radii;
};

/// Sorts the grains along cells and rebuilds the neighbour list. Contacts get their slots in it, or
/// DIG_NO_SLOT; pairs of one type take its order. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_lists_rebuild(struct dig_world *world, struct dig_skin skin);

/// The same without contacts, which the lists hold no longer: for who keeps them elsewhere.
/// order[k], of [grains + 1], is where grain k was. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_lists_sort(struct dig_world *world, struct dig_skin skin,
                                              uint32_t order[]);

/// Maps contacts to their grains' new indices: new_index[old], UINT32_MAX: removed.
void dig_lists_renumber(struct dig_world *world, const uint32_t new_index[]);

void dig_lists_finish(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_WORLD_LISTS_H
