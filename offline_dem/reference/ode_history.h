// What contacts remember, by the numbers of the two that touch: the all-ODE engine keeps no lists.
// Two hash tables: contacts of this step are taken over from the last one's, and what was not
// touched in a step is forgotten.

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

/// The memory of the contact between a and b, zero if it is new. It stays valid until the next
/// call. NULL when memory is short.
struct dig_contact_history *dig_ode_history_of(struct dig_ode_history *map, uint32_t a, uint32_t b);

/// What it remembered after the last step, NULL: nothing. Does not keep it for the next.
const struct dig_contact_history *dig_ode_history_previous(const struct dig_ode_history *map,
                                                           uint32_t a, uint32_t b);

/// The step is over.
void dig_ode_history_end_step(struct dig_ode_history *map);

/// A zeroed map is allowed; so is one that was finished.
void dig_ode_history_finish(struct dig_ode_history *map);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_HISTORY_H
