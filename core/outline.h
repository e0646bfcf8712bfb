// Outlines of a table's curves, drawn once when it is loaded: the means of each curve over blocks
// of the path, and the table's pooled spread. With them no match has to read every curve.

#ifndef DIG_CORE_OUTLINE_H
#define DIG_CORE_OUTLINE_H

#include "core/curve.h"

#define DIG_OUTLINE_BLOCKS 16
#define DIG_OUTLINE_POINTS 16 // of a curve, in a block
_Static_assert(DIG_OUTLINE_BLOCKS *DIG_OUTLINE_POINTS == DIG_CURVE_POINTS, "all of a curve");

/// Means over the blocks of one channel of a curve. 192 bytes a curve for moment and forces.
struct dig_outline {
    float block[DIG_OUTLINE_BLOCKS];
};

/// Index of the outline of a channel of curve [slot]. Ordered by use: those of the moment, in the
/// set's order, for the nearest search; then of each curve the forces, for the noise-weighted
/// distance.
static inline size_t dig_outline_place(const struct dig_curve_set *const set, const size_t channel,
                                       const size_t slot)
{
    const size_t curves = set->entries * set->trajectories;
    return channel == 0 ? slot : curves + slot * (DIG_FORCE_CHANNELS - 1) + channel - 1;
}

/// The outline of a channel of the set's curve [slot].
static inline const float *dig_outline_mean(const struct dig_curve_set *const set,
                                            const size_t channel, const size_t slot)
{
    return set->outline[dig_outline_place(set, channel, slot)].block;
}

/// Fills set->outline, which has its memory, and set->relative2. Reads every curve once: a few
/// microseconds each. Again when a curve of the set changes.
void dig_outlines_draw(struct dig_curve_set *set);

#endif // DIG_CORE_OUTLINE_H
