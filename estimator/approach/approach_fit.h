// How a dig was made, told from the bucket's way.
//
// The attack is the angle by which the bucket stands otherwise than the trajectory's all along; the
// depth is how much farther the first phase went before the others began. Where the ground lies is
// not known, so the way may be shifted; where on it the dig began is.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H

#include "core/approach.h"
#include "core/curve.h"
#include "estimator/track/route.h"

#include <stddef.h>

#define DIG_APPROACH_FIT_POINTS 64

/// How the trajectory was dug by a bucket whose way is told at equal steps of its progress, first
/// to last, rig scale: least squares over depth, attack and shift (Gauss-Newton, a dozen steps).
/// depth_m as dig_approach_depth_m() has it; where it is not above 0 the depth is taken to be 1.
/// Returns the rms distance of way and trajectory dug so, m. Some hundred microseconds.
double dig_approach_fit(const struct dig_trajectory *trajectory, double tooth_m, double depth_m,
                        const struct dig_path_point way[DIG_APPROACH_FIT_POINTS],
                        struct dig_approach        *approach);

/// The rms distance of the way and the trajectory as it stands, likewise up to a shift, m.
double dig_approach_off_m(const struct dig_trajectory *trajectory, double tooth_m,
                          const struct dig_path_point way[DIG_APPROACH_FIT_POINTS]);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_FIT_H
