// Detects stuck values: a sender without a counter whose frames go on while its values are frozen.
//
// Pressures of a moving front change: they are stuck when all six are constant to the bit while
// boom or arm turns by more than DIG_STUCK_rad. Angles of a front under changing load change: they
// are stuck when all three are constant for stuck_s while a pressure changes by more than
// DIG_STUCK_Pa. Neither detects a machine at rest, nor one that moves its bucket alone in the air.

#ifndef DIG_FIRMWARE_HOST_BUS_STUCK_H
#define DIG_FIRMWARE_HOST_BUS_STUCK_H

#include "core/sample.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_STUCK_rad 0.1 // gravity's moment changes by several steps of pressure
#define DIG_STUCK_Pa  1e6 // beyond the pressure ripple of an idling engine

/// Zeroed: nothing seen yet.
struct dig_stuck {
    bool    started;
    double  angle_rad[3], pressure_Pa[6]; // the last ones
    int64_t angles_ns;                    // since when the angles are constant
    double  low_Pa[6], high_Pa[6];        // of the pressures while the angles were constant
    double  low_rad[2], high_rad[2];      // of boom and arm while the pressures were constant
};

/// Steps by a sample that gives the moment; true while its pressures or angles are stuck. Pressures
/// are judged only where all six are measured: the bucket's alone may well be constant.
bool dig_stuck_step(struct dig_stuck *stuck, double stuck_s, const struct dig_sample *sample);

#endif // DIG_FIRMWARE_HOST_BUS_STUCK_H
