// Forces that are older than the pose beside them: a delay adds -delay dF/dt to a dig. A
// first-order filter of the load cell does exactly that, F being the forces as read.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H
#define DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H

#include "closed_loop/recordings/measured.h"

/// Derivative of a measured dig's features by its own time, from its smoothed curves: N m/s and N/s
/// at rig scale; 0 where not measured. trajectory: the table's, whose duration is that of the dig
/// times its pace.
void dig_lateness_rate(const struct dig_trajectory *trajectory, double tooth_m,
                       const struct dig_measured *dig, double rate[DIG_FEATURES]);

/// Replaces every dig's rate by the mean over its trajectory's digs that fit[] allows, at its own
/// pace: what one bed has alone is no late reading.
void dig_lateness_share(size_t digs, struct dig_measured measured[], const bool fit[]);

/// Delays a curve over progress, of a dig of that pace, by delay_s; in place.
void dig_lateness_delay(const struct dig_trajectory *trajectory, double tooth_m, double pace,
                        double delay_s, double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_LATENESS_H
