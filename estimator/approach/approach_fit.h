// Fits depth and attack of a dig to the bucket's path.
//
// The attack is a constant angle of the bucket against the trajectory; the depth is how much
// farther the first phase went before the others began. Where the ground lies is not known, so the
// path may be shifted; where on it the dig began is known.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H

#include "core/approach.h"
#include "core/curve.h"
#include "estimator/track/route.h"

#include <stddef.h>

#define DIG_APPROACH_FIT_POINTS 64

/// Fits depth and attack to a path given at equal steps of its progress, first to last, rig scale:
/// least squares over depth, attack and shift (Gauss-Newton, a dozen steps). depth_m as by
/// dig_approach_depth_m(); where it is not above 0 the depth is 1. Returns the rms distance of path
/// and fitted trajectory, m. Some hundred microseconds.
double dig_approach_fit(const struct dig_trajectory *trajectory, double tooth_m, double depth_m,
                        const struct dig_path_point path[DIG_APPROACH_FIT_POINTS],
                        struct dig_approach        *approach);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H
