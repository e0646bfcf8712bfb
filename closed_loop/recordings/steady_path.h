// Removes noise and steps of the path sensors from a recording's poses. Summed row by row they
// would lengthen the path.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
#define DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H

#include "core/recording.h"

/// Smooths the poses of the rows in place. Where rows repeat a reading, it is interpolated from the
/// middle of that stay to the middle of the next, for no longer than the shorter of both lasts.
/// Then the path is smoothed, over twice as much each time, until its length no longer falls:
/// smoothing shortens noise, and hardly a path. An exact path is left as it is, and so are its
/// ends. room: [rows]; number: [rows + 1]. O(rows log rows).
void dig_steady_path(struct dig_recording *recording, double tooth_m, struct dig_force_row room[],
                     double number[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
