// Where a dig left its trajectory for good, told by its path alone.
//
//      trajectory   \                 |          a load lifted short of the last leg: all of the
//                    \                |          path fits it badly, at a shift that puts this way
//                     \______|________|          up on that leg; what was dug before fits it well,
//                            |                   and then stands away from all that was left to dig
//      the bucket's way out, a load in it
//
// A hand may swerve and come back, or drag on beyond a corner: neither is a departure.

#ifndef DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H
#define DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H

#include "estimator/track/path.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#include <stdbool.h>

struct dig_abort_detection {
    struct dig_track track;    // of the path before
    size_t           until;    // vertices that it was fitted to
    double           progress; // where it left
};

/// True, and told, when the path left the route: up to some vertex it fits within a quarter of
/// limit_m and twice as well as whole, and beyond the first corner, so that the shift is known; its
/// last vertex in soil is farther than limit_m from all that was left; and it did not leave the way
/// it was going. Not within DIG_ENDING_LEAST of the start, nor from DIG_ENDING_WHOLE_FROM on.
/// whole: the fit of the whole path. Some milliseconds at most; none where that fits well.
bool dig_abort_detection_find(const struct dig_route *route, const struct dig_path *path,
                              double limit_m, const struct dig_track *whole,
                              struct dig_abort_detection *departure);

/// Of the routes the one that the path left, where up to there it fits no other within tie_m; -1:
/// none. whole: the fits of the whole path.
int dig_abort_detection_choose(size_t routes, const struct dig_route route[],
                               const struct dig_path *path, double limit_m, double tie_m,
                               const struct dig_track      whole[],
                               struct dig_abort_detection *departure);

#endif // DIG_ESTIMATOR_TRACK_ABORT_DETECTION_H
