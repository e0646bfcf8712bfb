// Removes noise and steps of the path sensors from a recording's poses. Summed row by row they
// would lengthen the path.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
#define DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H

#include "core/recording.h"

/// A repeated reading is interpolated from the middle of its stay to the middle of the next, for no
/// longer than the shorter of both lasts, where they differ by more than least. O(readings).
void dig_steady_readings(size_t readings, double least, double value[]);

/// Smooths the poses of the rows in place, over twice as much each time, until the path's length no
/// longer falls: smoothing shortens noise, and hardly a path. An exact path is left as it is, and
/// so are its ends. Returns how far, see dig_steady_average(). room: so many rows; number: twice as
/// many and one. O(rows log rows).
size_t dig_steady_smooth(struct dig_recording *recording, double tooth_m,
                         struct dig_force_row room[], double number[]);

/// Smooths other readings of the same rows as far. number: one more than readings.
void dig_steady_average(size_t readings, size_t far, double value[], double number[]);

/// Steps, then noise, of a path whose poses themselves are read. Room as above.
void dig_steady_path(struct dig_recording *recording, double tooth_m, struct dig_force_row room[],
                     double number[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
