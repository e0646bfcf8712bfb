// What contacts remember, by the numbers of the two that touch: the all-ODE engine keeps no lists.
// Two hash tables: contacts of this step are taken over from the last one's, and what was not
// touched in a step is forgotten.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_MEMORY_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_MEMORY_H

#include "offline_dem/law/law.h"

#include <stddef.h>
#include <stdint.h>

struct dig_ode_slot {
    uint64_t          key; // 0: free
    struct dig_memory memory;
};

struct dig_ode_memory {
    size_t               room[2], used[2];
    struct dig_ode_slot *slot[2]; // [room], a power of two, at most half of it used
    int                  now;
};

/// The memory of the contact between a and b, zero if it is new. It stays valid until the next
/// call. NULL when memory is short.
struct dig_memory *dig_ode_memory_of(struct dig_ode_memory *map, uint32_t a, uint32_t b);

/// What it remembered after the last step, NULL: nothing. Does not keep it for the next.
const struct dig_memory *dig_ode_memory_was(const struct dig_ode_memory *map, uint32_t a,
                                            uint32_t b);

/// The step is over.
void dig_ode_memory_turn(struct dig_ode_memory *map);

/// A zeroed map is allowed; so is one that was finished.
void dig_ode_memory_finish(struct dig_ode_memory *map);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_MEMORY_H
