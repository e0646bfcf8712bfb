// Response of a gravel's curves to depth and attack: the curve dug there minus the plain curve, at
// equal times (a phase lasts as long however deep it goes).

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_RESPONSE_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_RESPONSE_H

#include "core/approach.h"
#include "core/curve.h"

#include <stdbool.h>

/// Over the path of the trajectory dug so; relative to the rms of each channel's plain curve.
struct dig_response {
    double change[DIG_CHANNELS][DIG_CURVE_POINTS];
    double plain[DIG_CHANNELS][DIG_CURVE_POINTS]; // the plain curve at the same times, in its unit
    double scatter2[DIG_CHANNELS];                // of the means behind the change, squared
    double rms[DIG_CHANNELS];                     // of the plain curve, in its unit
    double inverse_packings;                      // of the resulting curve
};

/// By the entry's own digs, weighted as by dig_approach_weigh(), over the path of the trajectory
/// dug at `along` (mostly the same). False when they do not reach so far.
bool dig_response_own(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                      const struct dig_approach *approach, const struct dig_approach *along,
                      struct dig_response *response);

/// By the digs of all other entries that reach so far, the nearest gravels most: 1 / distance^2 on
/// axes from 0 to 1. own: dig_response_own() of each entry along that approach, NULL where it is
/// false; or NULL: computed here. False when there is none. O(entries).
bool dig_response_borrowed(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                           const struct dig_approach       *approach,
                           const struct dig_response *const own[], struct dig_response *response);

/// The trajectory of the set at an approach; the plain one where that cannot be.
struct dig_trajectory dig_response_trajectory(const struct dig_curve_set *set, size_t trajectory,
                                              const struct dig_approach *approach);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_RESPONSE_H
