// How a finished dig ended: dug to the end of its trajectory, or given up before.
//
//      told WHOLE      ------------->|        0.95 of the path or more was dug
//      told ABORTED    -----.                 the bucket stands away from all that was left to dig
//                           |
//      told OPEN       ------ - - - >         it was on its way when the soil was last felt: light
//                                             gravel is often not felt along the last leg; or no
//                                             one knows where along its trajectory it was

#ifndef DIG_ESTIMATOR_TRACK_ENDING_H
#define DIG_ESTIMATOR_TRACK_ENDING_H

#include "estimator/track/observation.h"
#include "estimator/track/path.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#include <stdbool.h>

/// From here on a dig is whole: a hand may leave the path a little before its end.
#define DIG_ENDING_WHOLE_FROM 0.95

/// A dig shorter than this share of its trajectory is not worth matching, nor told as given up.
#define DIG_ENDING_LEAST 0.2

/// reached: furthest progress. last: where the bucket was when the dig was over. Aborted is what is
/// farther than limit_m then from every place of the route that was left to dig. O(corners).
enum dig_ending dig_ending_of(const struct dig_route *route, const struct dig_track *track,
                              double reached, const struct dig_path_point *last, double limit_m);

/// Whether the path tells where along the route it lies: what of it is on the route, a little
/// before contact included, ends on the first leg or goes round a corner. A straight piece of a
/// later leg, of a dig that is felt along that one alone, lies as well anywhere on it.
/// O(vertices * corners).
bool dig_ending_is_known(const struct dig_route *route, const struct dig_track *track,
                         const struct dig_path *path, double limit_m);

#endif // DIG_ESTIMATOR_TRACK_ENDING_H
