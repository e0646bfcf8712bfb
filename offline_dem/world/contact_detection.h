// Contact detection: the pairs and surfaces that may touch before the next detection, from the
// neighbour list. The law runs over these lists. Known contacts keep their history.

#ifndef DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H
#define DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H

#include "offline_dem/world/world.h"

/// Pairs of grains; the slot of a contact is its place in the neighbour list. DIG_ENOMEM leaves the
/// lists as they were.
DIG_MUST_CHECK enum dig_status dig_contact_detection_pairs(struct dig_world *world);

/// Grains with walls, plates of the tool and rocks, likewise.
DIG_MUST_CHECK enum dig_status dig_contact_detection_surfaces(struct dig_world *world);

void dig_contact_detection_finish(struct dig_contact_detection *detection);

#endif // DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H
