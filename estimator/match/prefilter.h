// A table summed up once, when it is loaded, so that no match has to look at every curve of it: the
// outline of each curve, block by block along the path, and the table's pooled spread.

#ifndef DIG_ESTIMATOR_MATCH_PREFILTER_H
#define DIG_ESTIMATOR_MATCH_PREFILTER_H

#include "core/curve.h"

#include <stddef.h>

#define DIG_OUTLINE_BLOCKS 16
#define DIG_OUTLINE_POINTS 16 // of a curve, in a block
_Static_assert(DIG_OUTLINE_BLOCKS *DIG_OUTLINE_POINTS == DIG_CURVE_POINTS, "all of a curve");

/// What is outlined of a curve: of each channel the mean, then the standard deviation.
#define DIG_OUTLINE_LAYERS 6
_Static_assert(DIG_OUTLINE_LAYERS == 2 * DIG_FORCE_CHANNELS, "two of each channel");

/// Means over the blocks of one curve, one layer of it; NaN where nothing was dug.
struct dig_outline {
    float block[DIG_OUTLINE_BLOCKS];
};

/// Read-only once made. It tells of the set as it was then: change a curve, and make it anew.
struct dig_prefilter {
    const struct dig_curve_set *set;
    // [entries * trajectories] of the moments' means, in the set's order, as who looks for the
    // nearest reads no more; then of each curve the forces' means, which the noise-weighted
    // distance looks at besides; then of each the standard deviations.
    const struct dig_outline *outline;
    double                    relative2[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS];
};

/// Means over the blocks of one layer of a curve.
void dig_outline_draw(const float of[DIG_CURVE_POINTS], struct dig_outline *outline);

/// Outlines that a summary of the set needs: the caller brings the memory, 384 bytes a curve.
size_t dig_prefilter_outlines(const struct dig_curve_set *set);

/// Where the outline of a layer of curve [slot] lies.
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

/// Sums the set up; it and the outlines must outlive *summary. Reads every curve once: a few
/// microseconds each.
void dig_prefilter_make(const struct dig_curve_set *set, struct dig_outline outline[],
                        struct dig_prefilter *prefilter);

/// Squared spread of one dig relative to the mean, over all entries of the trajectory, each
/// counting alike; 0 when there is none. O(entries).
double dig_prefilter_relative2(const struct dig_curve_set *set, size_t trajectory,
                               enum dig_channel channel);

#endif // DIG_ESTIMATOR_MATCH_PREFILTER_H
