// Values that stand to the bit although they cannot: a sender whose frames go on while its values
// froze, and who has no counter to tell it by.
//
// Pressures of a moving front change: while all six stand, boom or arm may turn by DIG_STUCK_rad.
// Angles of a front that is loaded or unloaded change: while all three stand for stuck_s, a
// pressure may go by DIG_STUCK_Pa. A machine that stands still, or one that digs with its bucket
// alone in the air, is told as stuck by neither.

#ifndef DIG_FIRMWARE_HOST_BUS_STUCK_H
#define DIG_FIRMWARE_HOST_BUS_STUCK_H

#include "core/sample.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_STUCK_rad 0.1 // of gravity's moment on boom and arm that is several steps of pressure
#define DIG_STUCK_Pa  1e6 // what no standing engine's ripple makes

/// Zeroed: nothing seen yet.
struct dig_stuck {
    bool    started;
    double  angle_rad[3], pressure_Pa[6]; // as they stand
    int64_t angles_ns;                    // since when the angles stand
    double  low_Pa[6], high_Pa[6];        // of the pressures while the angles stood
    double  low_rad[2], high_rad[2];      // of boom and arm while the pressures stood
};

/// Takes a sample that tells the moment; true while its pressures or angles are stuck. Pressures
/// are told as stuck only where all six are there: the bucket's alone may well stand.
bool dig_stuck_step(struct dig_stuck *stuck, double stuck_s, const struct dig_sample *sample);

#endif // DIG_FIRMWARE_HOST_BUS_STUCK_H
