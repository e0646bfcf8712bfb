// Slots of digs at several depths and attacks: the table they are matched with has one trajectory
// for each slot (estimator/approach/approached.h).

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_SLOTS_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_SLOTS_H

#include "core/observation.h"
#include "estimator/approach/approached.h"

#include <stdbool.h>

/// Zeroed: none.
struct dig_approach_slots {
    size_t                     slots;
    struct dig_approached_slot slot[DIG_TRAJECTORY_MAX];
};

/// True where the table was dug at any depth or attack but the plain one, along this trajectory;
/// along any of them.
bool dig_approach_varies(const struct dig_curve_set *set, size_t trajectory);
bool dig_approach_varies_any(const struct dig_curve_set *set);

/// The index of the slot for a dig along a trajectory of the set: an existing one within half a
/// hundredth of a bucket length of path, else a new one; when all are taken the nearest of the
/// trajectory, or -1.
int dig_approach_slot(const struct dig_curve_set *set, size_t trajectory,
                      const struct dig_approach *approach, struct dig_approach_slots *slots);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_SLOTS_H
