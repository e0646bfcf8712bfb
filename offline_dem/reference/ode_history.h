// Contact histories by the numbers of the two bodies: the ODE engine keeps no lists. Two hash
// tables: contacts of this step take over the histories of the last one, and contacts that ended
// are dropped.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_HISTORY_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_HISTORY_H

#include "offline_dem/law/law.h"

#include <stddef.h>
#include <stdint.h>

struct dig_ode_slot {
    uint64_t                   key; // 0: free
    struct dig_contact_history history;
};

struct dig_ode_history {
    size_t               room[2], used[2];
    struct dig_ode_slot *slot[2]; // [room], a power of two, at most half of it used
    int                  now;
};

/// History of the contact between a and b, zero if it is new. Valid until the next call. NULL when
/// memory is short.
struct dig_contact_history *dig_ode_history_of(struct dig_ode_history *map, uint32_t a, uint32_t b);

/// History after the last step, NULL: none. Does not keep it for the next.
const struct dig_contact_history *dig_ode_history_previous(const struct dig_ode_history *map,
                                                           uint32_t a, uint32_t b);

/// Ends the step.
void dig_ode_history_end_step(struct dig_ode_history *map);

/// A zeroed map is allowed; so is one that was finished.
void dig_ode_history_finish(struct dig_ode_history *map);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_HISTORY_H
