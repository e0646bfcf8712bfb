// The path of a recording as the bucket went it, where its sensors read it in steps or with noise:
// steps and noise make way to and fro that no bucket went.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
#define DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H

#include "core/recording.h"

/// Mends the poses of the rows. A reading that rows repeat goes straight from the middle of its
/// stay to that of the next, for no longer than the shorter of both lasts. Then the path is
/// smoothed, twice as far each time, until its length is no longer a matter of how far: that of a
/// way is not, that of noise is. A path that each row reads anew, and without noise, stays as it
/// is, and so do its ends. room: so many rows; number: one more. O(rows log rows).
void dig_steady_path(struct dig_recording *recording, double tooth_m, struct dig_force_row room[],
                     double number[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_STEADY_PATH_H
