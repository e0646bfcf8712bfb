// Forces that are older than the pose beside them: what that adds to a recorded dig. A load cell
// with a filter is late, too: it reads F - delay dF/dt of what it will have read.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H
#define DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H

#include "closed_loop/recordings/measured.h"

/// How fast the features of a dig that was measured change with its own time, as its curves have
/// it: N m/s and N/s at rig scale; 0 where not measured. trajectory: the table's, as long as the
/// dig is over its pace.
void dig_lateness_rate(const struct dig_trajectory *trajectory, double tooth_m,
                       const struct dig_measured *dig, double rate[DIG_FEATURES]);

/// Leaves in every dig's rate the mean of its trajectory's digs that fit[] allows, by its own pace:
/// beds differ, and what one bed has of its own is no reading that is late.
void dig_lateness_share(size_t digs, struct dig_measured measured[], const bool fit[]);

/// Reads a curve of a dig of that pace, over progress, so much later; in place.
void dig_lateness_delay(const struct dig_trajectory *trajectory, double tooth_m, double pace,
                        double delay_s, double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H
