// Beds with an effect of the soil: curves of a table's digs in beds that hold one effect at one
// magnitude, at a few gravels. Loaded by tables/load_effects.h.

#ifndef DIG_CORE_EFFECT_SET_H
#define DIG_CORE_EFFECT_SET_H

#include "core/curve.h"
#include "core/effect.h"

/// One bed with one effect: its curves beside the table's plain ones.
struct dig_effect_entry {
    enum dig_effect_id effect;
    double             magnitude; // in the effect's own unit; never the value at which it is absent
    struct dig_gravel  gravel;    // of the plain bed it was made from
};

/// Flat and read-only. curve[entry * trajectories + trajectory]; packings 0: not computed. A plain
/// bed of the same gravel and packing was made from the same seed.
struct dig_effect_set {
    char                     scene_hash[65]; // of the plain scene: that of the table it belongs to
    size_t                   trajectories;   // as in the table, in its order
    size_t                   entries;        // ordered by effect, gravel, magnitude
    struct dig_effect_entry *entry;          // [entries]
    int                     *packings;       // [entries * trajectories]
    struct dig_curve        *curve;          // [entries * trajectories]
};

#endif // DIG_CORE_EFFECT_SET_H
