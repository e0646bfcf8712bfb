#include "estimator/ending.h"

#include <assert.h>
#include <stddef.h>

enum dig_ending dig_ending_of(const struct dig_route *const route,
                              const struct dig_track *const track, const double reached,
                              const struct dig_path_point *const last, const double limit_m)
{
    assert(route != NULL && track != NULL && last != NULL);
    if (reached >= DIG_ENDING_WHOLE_FROM) {
        return DIG_ENDING_WHOLE;
    }
    const struct dig_path_point at = dig_track_turned(track, last);
    const struct dig_place      place =
        dig_route_place(route, track->dx_m, track->dz_m, &at, reached, 1.0);
    return place.distance_m > limit_m ? DIG_ENDING_ABORTED : DIG_ENDING_OPEN;
}
