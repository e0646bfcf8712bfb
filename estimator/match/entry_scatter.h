// How one dig scatters about the mean of its gravel: by the table's standard deviations, point by
// point, but not independently of point and channel. The error of channel c at path s, in standard
// deviations, is normal, with
//
//   r(s, s') = (1 - shared) exp(-(s - s')^2 / (2 l^2)) + shared        along one channel
//
// and between channels the correlations of estimator/match/posterior.h times that. The table's
// packings show this shape (tests/estimator/test_entry_scatter.c).
//
//   white knots, l apart -> sums under exp(-(s - knot)^2 / l^2), normalised -> a dig's error

#ifndef DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H
#define DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H

#include "core/curve.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_ENTRY_SCATTER_REACH 4 // knots to either side that a point feels
#define DIG_ENTRY_SCATTER_WIDE  (2 * DIG_ENTRY_SCATTER_REACH + 1)
#define DIG_ENTRY_SCATTER_KNOTS (DIG_CURVE_POINTS + DIG_ENTRY_SCATTER_WIDE)

/// l sqrt(2 pi), in bucket lengths: measured over three trajectories of tables/rig.sqlite, within
/// 0.13 of what its packings show for each channel of each. (What DIG_POSTERIOR_CORRELATION counts
/// errors by was measured on fewer digs, of LIGGGHTS.)
#define DIG_ENTRY_SCATTER_WIDTH 0.21

/// What of a dig's error is the same all along it: the table's packings are still correlated by
/// 0.03 to 0.06 where points are more than half a bucket length apart.
#define DIG_ENTRY_SCATTER_SHARED 0.04

/// Of one trajectory; 20 kB.
struct dig_entry_scatter {
    size_t knots;
    size_t first[DIG_CURVE_POINTS]; // knot a point feels, and how much that and the next ones
    double felt[DIG_CURVE_POINTS][DIG_ENTRY_SCATTER_WIDE];
};

/// A number for each channel at each point.
struct dig_channels {
    double of[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

/// 50 microseconds.
void dig_entry_scatter_make(const struct dig_trajectory *trajectory, double tooth_m,
                            struct dig_entry_scatter *spread);

/// Error of one dig in one channel, in standard deviations. The same of the same seed, which moves
/// on. 5 microseconds.
void dig_entry_scatter_draw(const struct dig_entry_scatter *spread, uint64_t *seed,
                            double error[DIG_CURVE_POINTS]);

/// Variance of sum over channels and points of (weight * error), the weights being those of one
/// standard deviation each. Exact. 10 microseconds.
double dig_entry_scatter_variance(const struct dig_entry_scatter *spread,
                                  const struct dig_channels      *weight);

#endif // DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H
