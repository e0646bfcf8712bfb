// Removes noise and steps of the path sensors from a recording's poses.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
#define DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H

#include "core/recording.h"

/// Steps, then noise, of a path whose poses themselves are read (estimator/track/steady.h), in
/// place. number: four times as many as rows, and one. O(rows log rows).
void dig_steady_path(struct dig_recording *recording, double tooth_m, double number[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
