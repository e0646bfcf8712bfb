// Contacts of a grain with the bucket for the ODE engine: the rules of surfaces.h, grain by grain
// instead of list by list.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H

#include "offline_dem/reference/ode_history.h"
#include "offline_dem/shapes/tool.h"

/// A local minimum of the distance to all plates together. Plates that share it, as two do at an
/// edge, share its history.
struct dig_ode_plate_contact {
    double                     closest_m[3]; // body frame
    size_t                     plates;
    size_t                     plate[DIG_PLATES_MAX];
    struct dig_contact_history history;
};

/// Contacts of a grain at body_m, with their histories of the last step: a contact that moved from
/// plate to plate keeps its own. Returns how many.
size_t dig_ode_plates_find(const struct dig_tool *tool, const double body_m[3], double radius_m,
                           uint32_t grain, const struct dig_ode_history *map,
                           struct dig_ode_plate_contact contact[DIG_PLATES_MAX]);

/// Stores the contact's history for the next step. False when memory is short.
bool dig_ode_plates_store(const struct dig_ode_plate_contact *contact, uint32_t grain,
                          struct dig_ode_history *map);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H
