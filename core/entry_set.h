// Entries of a table beside its plain ones: the same digs in beds that hold one effect, or deeper,
// or with the bucket turned, at gravels of the table. Loaded by tables/load.h.

#ifndef DIG_CORE_ENTRY_SET_H
#define DIG_CORE_ENTRY_SET_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/effect.h"

#include <stdint.h>

/// One gravel dug in one bed and one way.
struct dig_entry {
    struct dig_gravel   gravel; // of the plain bed it was made from
    struct dig_approach approach;
    enum dig_effect_id  effect;    // DIG_EFFECTS: none
    double              magnitude; // in the effect's own unit, never that at which it is absent
    int64_t             ground;    // its row in the table
};

/// Flat and read-only. curve[entry * trajectories + trajectory], over the path of the trajectory
/// dug so; packings 0: not computed. A plain bed of the same gravel and packing was made from the
/// same seed.
struct dig_entry_set {
    char              scene_hash[65];              // of the table's plain scene
    size_t            trajectories;                // as in the table, in its order
    double            depth_m[DIG_TRAJECTORY_MAX]; // dig_approach_depth_m() of each
    size_t            entries;  // ordered by effect, gravel, magnitude, depth, attack
    struct dig_entry *entry;    // [entries]
    int              *packings; // [entries * trajectories]
    struct dig_curve *curve;    // [entries * trajectories]
};

#endif // DIG_CORE_ENTRY_SET_H
