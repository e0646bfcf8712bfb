#include "estimator/track/ending.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// A vertex within this share of limit_m lies on the route. A corner counts as passed when it lay
// this far ahead and then lies this far behind.
static const double on_share   = 0.25;
static const double past_share = 0.5;

// Part of limit_m before contact that counts: contact is detected late.
enum { LEAD_VERTICES = 16 };

enum dig_ending dig_ending_of(const struct dig_route *const route,
                              const struct dig_track *const track, const double reached,
                              const struct dig_path_point *const last, const double limit_m)
{
    assert(route != NULL && track != NULL && last != NULL);
    if (reached >= DIG_ENDING_WHOLE_FROM) {
        return DIG_ENDING_WHOLE;
    }
    const struct dig_path_point at = dig_track_turned(track, last);
    const struct dig_projection place =
        dig_route_project(route, track->dx_m, track->dz_m, &at, reached, 1.0);
    return place.distance_m > limit_m ? DIG_ENDING_ABORTED : DIG_ENDING_OPEN;
}

bool dig_ending_is_known(const struct dig_route *const route, const struct dig_track *const track,
                         const struct dig_path *const path, const double limit_m)
{
    assert(route != NULL && track != NULL && path != NULL);
    const double length_m = route->at_m[route->corners - 1];
    const size_t from     = path->contact > LEAD_VERTICES ? path->contact - LEAD_VERTICES : 0;
    double       first_m  = INFINITY;
    double       last_m   = -INFINITY;
    for (size_t i = from; i < path->end; i++) {
        const struct dig_path_point at = dig_track_turned(track, &path->vertex[i]);
        const struct dig_projection place =
            dig_route_project(route, track->dx_m, track->dz_m, &at, 0.0, 1.0);
        if (place.distance_m <= on_share * limit_m) {
            first_m = fmin(first_m, place.progress * length_m);
            last_m  = fmax(last_m, place.progress * length_m);
        }
    }
    bool known = last_m >= 0.0 && last_m <= route->at_m[1];
    for (size_t c = 1; c + 1 < route->corners; c++) {
        known |= route->at_m[c] - first_m >= past_share * limit_m &&
                 last_m - route->at_m[c] >= past_share * limit_m;
    }
    return known;
}
