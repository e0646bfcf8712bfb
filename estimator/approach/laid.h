// Curves laid over the path at another depth. Paths of one trajectory at two depths differ in the
// length of their first leg alone; the corner at its end is common.
//
//   at depth 1.25   o------------.---------------.------      o start, . corners
//   at depth 1           o-------.---------------.------

#ifndef DIG_ESTIMATOR_APPROACH_LAID_H
#define DIG_ESTIMATOR_APPROACH_LAID_H

#include "core/curve.h"
#include "core/observation.h"

/// For each point of the path at one depth, its place (0 … DIG_CURVE_POINTS - 1) on the path at
/// another; negative before that one's start.
void dig_laid_places(const struct dig_curve_set *set, size_t trajectory, double depth,
                     double other_depth, double place[DIG_CURVE_POINTS]);

/// A curve at those places, in its own place; 0 before its start, where the bucket is in the air.
void dig_laid_curve(const double place[DIG_CURVE_POINTS], struct dig_curve *curve);

/// A dig observed over the path at dig->approach.depth, over that at another depth, which becomes
/// its approach's. What lies before its new start is dropped.
void dig_laid_observation(const struct dig_curve_set *set, double depth,
                          struct dig_observation *dig);

#endif // DIG_ESTIMATOR_APPROACH_LAID_H
