// Prefilter of the nearest search, made once when a table is loaded: the outline of each curve
// (means over blocks of the path) and the table's pooled spread. No match has to read every curve.

#ifndef DIG_ESTIMATOR_MATCH_PREFILTER_H
#define DIG_ESTIMATOR_MATCH_PREFILTER_H

#include "core/curve.h"

#include <stddef.h>

#define DIG_OUTLINE_BLOCKS 16
#define DIG_OUTLINE_POINTS 16 // of a curve, in a block
_Static_assert(DIG_OUTLINE_BLOCKS *DIG_OUTLINE_POINTS == DIG_CURVE_POINTS, "all of a curve");

/// Means over the blocks of one channel of a curve; NaN where nothing was dug.
struct dig_outline {
    float block[DIG_OUTLINE_BLOCKS];
};

/// Read-only once made. It must be made again when a curve of the set changes.
struct dig_prefilter {
    const struct dig_curve_set *set;
    // Ordered by use: [entries * trajectories] of the moment, in the set's order, for the nearest
    // search; then of each curve the forces, for the noise-weighted distance.
    const struct dig_outline *outline;
    double                    relative2[DIG_TRAJECTORY_MAX][DIG_COVARIANCE_NUMBERS];
};

/// Means over the blocks of one channel of a curve.
void dig_outline_draw(const float of[DIG_CURVE_POINTS], struct dig_outline *outline);

/// Number of outlines of a set, 192 bytes a curve, in memory of the caller.
size_t dig_prefilter_outlines(const struct dig_curve_set *set);

/// Index of the outline of a channel of curve [slot].
static inline size_t dig_outline_place(const struct dig_curve_set *const set, const size_t channel,
                                       const size_t slot)
{
    const size_t curves = set->entries * set->trajectories;
    return channel == 0 ? slot : curves + slot * (DIG_FORCE_CHANNELS - 1) + channel - 1;
}

/// The outline of a channel of the set's curve [slot].
static inline const float *dig_outline_mean(const struct dig_prefilter *const prefilter,
                                            const size_t channel, const size_t slot)
{
    return prefilter->outline[dig_outline_place(prefilter->set, channel, slot)].block;
}

/// Makes the prefilter; set and outlines must outlive it. Reads every curve once: a few
/// microseconds each.
void dig_prefilter_make(const struct dig_curve_set *set, struct dig_outline outline[],
                        struct dig_prefilter *prefilter);

/// Mean squared scatter of one dig in each block of a covariance (core/curve.h), relative to the
/// mean square of the curve, averaged over the entries of the trajectory; 0 when there is none.
/// O(entries).
void dig_prefilter_relative2(const struct dig_curve_set *set, size_t trajectory,
                             double relative2[DIG_COVARIANCE_NUMBERS]);

#endif // DIG_ESTIMATOR_MATCH_PREFILTER_H
