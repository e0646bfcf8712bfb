#include "estimator/approach/approach_slots.h"

#include "core/entry_set.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>

// Approaches nearer than this, in bucket lengths, share a slot: a curve changes by a per cent.
static const double alike = 0.005;

bool dig_approach_varies(const struct dig_curve_set *const set, const size_t trajectory)
{
    assert(set != NULL && trajectory < set->trajectories);
    const struct dig_entry_set *const other = set->approaches;
    bool                              any   = false;
    for (size_t i = 0; other != NULL && !any && i < other->entries; i++) {
        any = other->packings[i * other->trajectories + trajectory] > 0;
    }
    return any;
}

bool dig_approach_varies_any(const struct dig_curve_set *const set)
{
    bool any = false;
    for (size_t t = 0; !any && t < set->trajectories; t++) {
        any = dig_approach_varies(set, t);
    }
    return any;
}

int dig_approach_slot(const struct dig_curve_set *const set, const size_t trajectory,
                      const struct dig_approach *const approach,
                      struct dig_approach_slots *const slots)
{
    assert(set != NULL && approach != NULL && slots != NULL);
    int    nearest = -1;
    double least_m = INFINITY;
    for (size_t s = 0; s < slots->slots; s++) {
        const struct dig_approached_slot *const slot = &slots->slot[s];
        if (slot->trajectory == trajectory) {
            const double away_m =
                dig_approach_distance_m(set, trajectory, &slot->approach, approach);
            nearest = away_m < least_m ? (int)s : nearest;
            least_m = fmin(least_m, away_m);
        }
    }
    if (least_m <= alike * set->tooth_m || slots->slots == DIG_TRAJECTORY_MAX) {
        return nearest;
    }
    slots->slot[slots->slots] =
        (struct dig_approached_slot){ .trajectory = trajectory,
                                      .approach   = dig_approach_normalized(approach) };
    return (int)slots->slots++;
}
