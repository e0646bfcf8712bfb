// Pressures that a sensor or a relief valve cut off: what is missing there cannot be traced.

#ifndef DIG_CLOSED_LOOP_CLIPPED_H
#define DIG_CLOSED_LOOP_CLIPPED_H

#include "core/machine.h"
#include "core/recording.h"
#include "core/sample.h"

#include <stdbool.h>

struct dig_clip {
    enum dig_signal signal;
    double          limit_Pa; // where it ends
    double          time_s;   // how long it stands there, in all
};

/// True when a chamber's pressure piles up at its own highest value: it stands there for a second
/// or more, ten times as long as just below (within a step, or 1 %), which no load that comes and
/// goes does, and above twice the return side's pressure, where a chamber may well be constant.
/// *clip tells the worst; it is untouched otherwise. O(rows).
bool dig_clipped_find(const struct dig_machine           *machine,
                      const struct dig_machine_recording *recording, struct dig_clip *clip);

#endif // DIG_CLOSED_LOOP_CLIPPED_H
