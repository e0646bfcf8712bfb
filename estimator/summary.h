// A table summed up once, when it is loaded, so that no match has to look at every curve of it:
// the outline of each curve, block by block along the path, and the table's pooled spread.

#ifndef DIG_ESTIMATOR_SUMMARY_H
#define DIG_ESTIMATOR_SUMMARY_H

#include "core/curve.h"

#include <stddef.h>

#define DIG_OUTLINE_BLOCKS 32
#define DIG_OUTLINE_POINTS 8 // of a curve, in a block
_Static_assert(DIG_OUTLINE_BLOCKS *DIG_OUTLINE_POINTS == DIG_CURVE_POINTS, "all of a curve");

/// Means of the moment over the blocks of one curve; NaN where nothing was dug.
struct dig_outline {
    float moment_Nm[DIG_OUTLINE_BLOCKS];
};

/// Read-only once made. It tells of the set as it was then: change a curve, and make it anew.
struct dig_summary {
    const struct dig_curve_set *set;
    const struct dig_outline   *outline; // [entries * trajectories], as the set's curves
    double                      relative2[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS];
};

/// Outlines that a summary of the set needs: the caller brings the memory, 128 bytes each.
size_t dig_summary_outlines(const struct dig_curve_set *set);

/// Sums the set up; it and the outlines must outlive *summary. Reads every curve once: about a
/// microsecond each.
void dig_summary_make(const struct dig_curve_set *set, struct dig_outline outline[],
                      struct dig_summary *summary);

/// Squared spread of one dig relative to the mean, over all entries of the trajectory, each
/// counting alike; 0 when there is none. O(entries).
double dig_summary_relative2(const struct dig_curve_set *set, size_t trajectory,
                             enum dig_channel channel);

#endif // DIG_ESTIMATOR_SUMMARY_H
