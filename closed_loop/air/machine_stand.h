// Readings that stand. A sensor that is quiet beside its step reads one and the same number while a
// machine stands: all readings of a pose are rounded alike, and their mean is known no better than
// one of them. Noise of half a step spreads the rounding evenly, and the mean of many is sure.

#ifndef DIG_CLOSED_LOOP_AIR_MACHINE_STAND_H
#define DIG_CLOSED_LOOP_AIR_MACHINE_STAND_H

#include "closed_loop/air/machine_air.h"

/// Raises the sigma of the segment's rows in which a chamber stands, so that together they tell as
/// much of its pressure as there are roundings: one, and one more for every step that its reading
/// goes meanwhile. Rows whose readings change from sample to sample stay as they are.
void dig_stand_widen(struct dig_air *air, const struct dig_air_segment *segment,
                     const struct dig_machine_dig *dig);

#endif // DIG_CLOSED_LOOP_AIR_MACHINE_STAND_H
