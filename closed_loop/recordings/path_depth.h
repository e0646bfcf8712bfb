// Depth of a dig along its path, beyond that of its trajectory.
//
//     trajectory   ---\_______________/
//     dig          ---\_____          /      deeper: by how much, over the depth of the first leg
//                           `--------´       0 along the first leg: where the ground lies is not
//                           asked

#ifndef DIG_CLOSED_LOOP_RECORDINGS_PATH_DEPTH_H
#define DIG_CLOSED_LOOP_RECORDINGS_PATH_DEPTH_H

#include "core/curve.h"
#include "estimator/track/route.h"

#include <stddef.h>

/// Zeroed: nothing is known yet.
struct dig_path_depth {
    double deeper_m[DIG_CURVE_POINTS]; // sums
    size_t poses[DIG_CURVE_POINTS];
};

/// Adds a pose of the dig, which is at that progress of a route along which the bucket is turned by
/// attack_rad. O(corners).
void dig_path_depth_add(struct dig_path_depth *depth, const struct dig_route *route, double tooth_m,
                        double attack_rad, double progress, const struct dig_path_point *pose);

/// How much deeper the dig is at each point, over depth_m, against its first leg; straight between
/// points that have a pose, and as the last one behind it. Zeros where no pose is of the first leg.
void dig_path_depth_tell(const struct dig_path_depth *depth, const struct dig_route *route,
                         double depth_m, double deeper[DIG_CURVE_POINTS]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_PATH_DEPTH_H
