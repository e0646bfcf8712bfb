// Removes noise and steps of a path's sensors. Summed from row to row they would lengthen the path,
// and a path that is blurred by them lies as near one trajectory as another.

#ifndef DIG_ESTIMATOR_TRACK_STEADY_H
#define DIG_ESTIMATOR_TRACK_STEADY_H

#include <stddef.h>

/// One of the three numbers of every pose, wherever they lie: every stride-th, times scale_m a
/// length. The third is the turn.
struct dig_steady_axis {
    double *value;
    size_t  stride;
    double  scale_m;
};

enum { DIG_STEADY_AXES = 3 };

/// A repeated reading is interpolated from the middle of its stay to the middle of the next, for no
/// longer than the shorter of both lasts, where they differ by more than least. O(readings).
void dig_steady_readings(size_t readings, double least, double value[]);

/// Smooths the poses in place, over twice as much each time, until the path's length over vertices
/// spacing_m apart no longer falls: smoothing shortens noise, and hardly a path. An exact path is
/// left as it is, and so are its ends. Returns how far, see dig_steady_average(): 0: it was left.
/// room: so many numbers an axis; sum: one more. O(poses log poses).
size_t dig_steady_smooth(size_t poses, const struct dig_steady_axis axis[DIG_STEADY_AXES],
                         double spacing_m, double *const room[DIG_STEADY_AXES], double sum[]);

/// Smooths other readings of the same rows as far. sum: one more than readings.
void dig_steady_average(size_t readings, size_t far, double value[], double sum[]);

#endif // DIG_ESTIMATOR_TRACK_STEADY_H
