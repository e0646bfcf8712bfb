// Detects an aborted dig by its path alone: where it left its trajectory for good.
//
//      trajectory   \                 |          A load lifted before the last leg: the whole path
//                    \                |          fits badly, at a shift that puts the way up on
//                    that
//                     \______|________|          leg. The path before fits well, and the rest lies
//                            |                   away from all that was left to dig.
//      the bucket's way out, loaded
//
// An operator may swerve and come back, or drag on beyond a corner: neither is an abort.

#ifndef DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H
#define DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H

#include "estimator/track/path.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#include <stdbool.h>

struct dig_abort_detection {
    struct dig_track track;    // of the path before it
    size_t           until;    // vertices the track was fitted to
    double           progress; // where the path left: the farthest within half of limit_m
};

/// Detects an abort; whole is the fit of the whole path. True, and *aborted is written, when
///   * up to some vertex beyond the first corner (the shift is then known) the path fits within a
///     quarter of limit_m and twice as well as the whole;
///   * its last vertex in soil is farther than limit_m from all that was left to dig;
///   * it did not leave straight ahead;
///   * it left between DIG_ENDING_LEAST and DIG_ENDING_WHOLE_FROM of the route.
/// Some milliseconds at most; none where the whole fits well.
bool dig_abort_detection_find(const struct dig_route *route, const struct dig_path *path,
                              double limit_m, const struct dig_track *whole,
                              struct dig_abort_detection *aborted);

/// The route that the path left, if up to there it fits no other as well (dig_track_choose()); -1:
/// none. whole: the fits of the whole path.
int dig_abort_detection_choose(size_t routes, const struct dig_route route[],
                               const struct dig_path *path, double limit_m,
                               const struct dig_track whole[], struct dig_abort_detection *aborted);

#endif // DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H
