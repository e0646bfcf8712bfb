// How a finished dig ended: whole (to the end of its trajectory) or aborted.
//
//      WHOLE      ------------->|        at least 0.95 of the path was dug
//      ABORTED    -----.                 the bucket ended away from all that was left to dig
//                      |
//      OPEN       ------ - - - >         not known: the soil was last felt on the way (light gravel
//                                        is often not felt along the last leg), or the dig's place
//                                        along its trajectory is not known

#ifndef DIG_ESTIMATOR_TRACK_ENDING_H
#define DIG_ESTIMATOR_TRACK_ENDING_H

#include "core/observation.h"
#include "estimator/track/path.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#include <stdbool.h>

/// From this progress on a dig is whole: operators leave the path a little before its end.
#define DIG_ENDING_WHOLE_FROM 0.95

/// A dig shorter than this share of its trajectory is neither matched nor counted as aborted: it
/// may be a touch of the ground.
#define DIG_ENDING_LEAST 0.2

/// reached: furthest progress. last: the bucket's pose when the dig was over; aborted if it is
/// farther than limit_m from all of the route that was left to dig. O(corners).
enum dig_ending dig_ending_of(const struct dig_route *route, const struct dig_track *track,
                              double reached, const struct dig_path_point *last, double limit_m);

/// Whether the path determines its place along the route: its part on the route, with a little
/// before contact, ends on the first leg or goes round a corner. A straight piece of a later leg
/// may lie anywhere on it. O(vertices * corners).
bool dig_ending_is_known(const struct dig_route *route, const struct dig_track *track,
                         const struct dig_path *path, double limit_m);

#endif // DIG_ESTIMATOR_TRACK_ENDING_H
