#include "tables/listed.h"

#include <assert.h>

size_t dig_listed_count(const struct dig_curve_set *const set)
{
    assert(set != NULL);
    return set->entries + (set->approaches != NULL ? set->approaches->entries : 0);
}

struct dig_listed dig_listed_at(const struct dig_curve_set *const set, const size_t entry,
                                const size_t trajectory)
{
    assert(entry < dig_listed_count(set) && trajectory < set->trajectories);
    struct dig_listed one = { .approach   = dig_approach_plain(),
                              .trajectory = set->trajectory[trajectory] };
    if (entry < set->entries) {
        const size_t at = entry * set->trajectories + trajectory;
        one.gravel      = set->gravel[entry];
        one.packings    = set->packings[at];
        one.curve       = &set->curve[at];
        return one;
    }
    const struct dig_entry_set *const other  = set->approaches;
    const struct dig_entry *const     dug_so = &other->entry[entry - set->entries];
    const size_t at = (entry - set->entries) * other->trajectories + trajectory;
    one.gravel      = dug_so->gravel;
    one.approach    = dug_so->approach;
    one.packings    = other->packings[at];
    one.curve       = &other->curve[at];

    // A table in which this fails was not made by us; its times are the plain one's then.
    struct dig_trajectory dug;
    if (dig_approach_apply(&set->trajectory[trajectory], set->tooth_m, other->depth_m[trajectory],
                           &dug_so->approach, &dug, NULL) == DIG_OK) {
        one.trajectory = dug;
    }
    return one;
}
