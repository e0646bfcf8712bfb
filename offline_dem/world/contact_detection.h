// Picks from all pairs and surfaces those that may touch before the next time: the lists the law
// runs over. Contacts that were known before keep what they remember.

#ifndef DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H
#define DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H

#include "offline_dem/world/world.h"

#define DIG_NO_SLOT UINT32_MAX // the key of a contact whose pair is in no neighbour list

/// From the neighbour list; the keys of known pairs are their places in it. DIG_ENOMEM leaves the
/// lists as they were.
DIG_MUST_CHECK enum dig_status dig_contact_detection_pairs(struct dig_world *world);

/// From the walls and the tool's plates, likewise.
DIG_MUST_CHECK enum dig_status dig_contact_detection_surfaces(struct dig_world *world);

void dig_contact_detection_finish(struct dig_contact_detection *detection);

#endif // DIG_OFFLINE_DEM_WORLD_CONTACT_DETECTION_H
