// Scatter of single digs about the mean of their gravel (an entry of the table): the table's
// standard deviations, correlated along the path and between channels. The error of channel c at
// path s, in standard deviations, is normal with correlation
//
//   r(s, s') = (1 - shared) exp(-(s - s')^2 / (2 l^2)) + shared        along one channel
//
// and between channels the correlations below times that. The table's
// packings show this shape (tests/estimator/test_entry_scatter.c).
//
//   white knots, l apart -> sums under exp(-(s - knot)^2 / l^2), normalised -> a dig's error

#ifndef DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H
#define DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H

#include "core/curve.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_ENTRY_SCATTER_REACH 4 // knots to either side that reach a point
#define DIG_ENTRY_SCATTER_WIDE  (2 * DIG_ENTRY_SCATTER_REACH + 1)
#define DIG_ENTRY_SCATTER_KNOTS (DIG_CURVE_POINTS + DIG_ENTRY_SCATTER_WIDE)

/// l sqrt(2 pi), in bucket lengths: measured over three trajectories of
/// tables/reference_rig.sqlite; each channel of each agrees within 0.13.
#define DIG_ENTRY_SCATTER_WIDTH 0.21

/// Share of a dig's error that is constant along it: the table's packings are correlated by 0.03 to
/// 0.06 where points are more than half a bucket length apart.
#define DIG_ENTRY_SCATTER_SHARED 0.04

/// Correlation of the errors of moment and forces of one dig, point by point: over ten packings
/// each of three gravels and three trajectories (tables/reference_rig.sqlite;
/// tests/estimator/test_force_correlation.c).
#define DIG_ENTRY_SCATTER_MY_FX (-0.93)
#define DIG_ENTRY_SCATTER_MY_FZ 0.63
#define DIG_ENTRY_SCATTER_FX_FZ (-0.49)

/// The same as a matrix, 1 on its diagonal.
extern const double dig_entry_scatter_between[DIG_FORCE_CHANNELS][DIG_FORCE_CHANNELS];

/// Of one trajectory; 20 kB.
struct dig_entry_scatter {
    size_t knots;
    size_t first[DIG_CURVE_POINTS]; // first knot that reaches a point; weights of it and the next
    double felt[DIG_CURVE_POINTS][DIG_ENTRY_SCATTER_WIDE];
};

/// One number for each channel at each point.
struct dig_channels {
    double of[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

/// 50 microseconds.
void dig_entry_scatter_make(const struct dig_trajectory *trajectory, double tooth_m,
                            struct dig_entry_scatter *scatter);

/// Draws the error of one dig in one channel, in standard deviations, and advances the seed. 5
/// microseconds.
void dig_entry_scatter_draw(const struct dig_entry_scatter *scatter, uint64_t *seed,
                            double error[DIG_CURVE_POINTS]);

/// Variance of sum over channels and points of (weight * error), the weights being those of one
/// standard deviation each. Exact. 10 microseconds.
double dig_entry_scatter_variance(const struct dig_entry_scatter *scatter,
                                  const struct dig_channels      *weight);

#endif // DIG_ESTIMATOR_MATCH_ENTRY_SCATTER_H
