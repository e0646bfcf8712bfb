// Prefilter of the nearest search, made once when a table is loaded: the outline of each curve
// (means over blocks of the path) and the table's pooled spread. No match has to read every curve.

#ifndef DIG_ESTIMATOR_MATCH_PREFILTER_H
#define DIG_ESTIMATOR_MATCH_PREFILTER_H

#include "core/curve.h"

#include <stddef.h>

#define DIG_OUTLINE_BLOCKS 16
#define DIG_OUTLINE_POINTS 16 // of a curve, in a block
_Static_assert(DIG_OUTLINE_BLOCKS *DIG_OUTLINE_POINTS == DIG_CURVE_POINTS, "all of a curve");

/// Layers of a curve: of each channel the mean, then the standard deviation.
#define DIG_OUTLINE_LAYERS 6
_Static_assert(DIG_OUTLINE_LAYERS == 2 * DIG_FORCE_CHANNELS, "two of each channel");

/// Means over the blocks of one curve, one layer of it; NaN where nothing was dug.
struct dig_outline {
    float block[DIG_OUTLINE_BLOCKS];
};

/// Read-only once made. It must be made again when a curve of the set changes.
struct dig_prefilter {
    const struct dig_curve_set *set;
    // Ordered by use: [entries * trajectories] of the moment's means, in the set's order, for the
    // nearest search; then of each curve the forces' means, for the noise-weighted distance; then
    // of each curve the standard deviations.
    const struct dig_outline *outline;
    double                    relative2[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS];
};

/// Means over the blocks of one layer of a curve.
void dig_outline_draw(const float of[DIG_CURVE_POINTS], struct dig_outline *outline);

/// Number of outlines of a set, 384 bytes a curve, in memory of the caller.
size_t dig_prefilter_outlines(const struct dig_curve_set *set);

/// Index of the outline of a layer of curve [slot].
static inline size_t dig_outline_place(const struct dig_curve_set *const set, const size_t layer,
                                       const size_t slot)
{
    const size_t curves = set->entries * set->trajectories;
    if (layer == 0) {
        return slot;
    }
    return layer % 2 == 0 ? curves + slot * (DIG_FORCE_CHANNELS - 1) + layer / 2 - 1
                          : (curves + slot) * DIG_FORCE_CHANNELS + layer / 2;
}

/// The outline of the set's curve [slot]: of its mean, and of its standard deviation.
static inline const float *dig_outline_mean(const struct dig_prefilter *const prefilter,
                                            const size_t channel, const size_t slot)
{
    return prefilter->outline[dig_outline_place(prefilter->set, 2 * channel, slot)].block;
}

static inline const float *dig_outline_sd(const struct dig_prefilter *const prefilter,
                                          const size_t channel, const size_t slot)
{
    return prefilter->outline[dig_outline_place(prefilter->set, 2 * channel + 1, slot)].block;
}

/// Makes the prefilter; set and outlines must outlive it. Reads every curve once: a few
/// microseconds each.
void dig_prefilter_make(const struct dig_curve_set *set, struct dig_outline outline[],
                        struct dig_prefilter *prefilter);

/// Squared spread of one dig relative to the mean, averaged over the entries of the trajectory; 0
/// when there is none. O(entries).
double dig_prefilter_relative2(const struct dig_curve_set *set, size_t trajectory,
                               enum dig_channel channel);

#endif // DIG_ESTIMATOR_MATCH_PREFILTER_H
