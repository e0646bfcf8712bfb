// Where a grain touches the bucket, for the all-ODE engine: the rules of surfaces.h, worked out
// grain by grain instead of list by list.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H

#include "offline_dem/reference/ode_history.h"
#include "offline_dem/shapes/tool.h"

/// A local minimum of the distance to all plates together. The plates that share it - an edge lies
/// on two - share its memory.
struct dig_ode_plate_contact {
    double                     closest_m[3]; // body frame
    size_t                     plates;
    size_t                     plate[DIG_PLATES_MAX];
    struct dig_contact_history history;
};

/// The touches of a grain of this number that stands at body_m, with what they remember of the last
/// step: a touch that moved on from plate to plate brings it along. Returns how many.
size_t dig_ode_plates_find(const struct dig_tool *tool, const double body_m[3], double radius_m,
                           uint32_t grain, const struct dig_ode_history *map,
                           struct dig_ode_plate_contact contact[DIG_PLATES_MAX]);

/// Keeps the touch's memory for the next step. False when memory is short.
bool dig_ode_plates_store(const struct dig_ode_plate_contact *contact, uint32_t grain,
                          struct dig_ode_history *map);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_PLATES_H
