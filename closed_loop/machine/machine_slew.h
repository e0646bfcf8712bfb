// Slewing while free air is recorded, which no recording tells. Masses are pulled outward by
// omega^2 times how far from the slew axis they are, here the boom pin; nothing of a machine or its
// sensors pulls so at one time and not at another.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H

#include "closed_loop/machine/machine_lines.h"

#include <stdbool.h>

/// Takes out of the air the rows of every second or more in which that pull, with one omega^2,
/// explains most of what the values at (those that explain most) leave, and clearly. True: any
/// went; what is left is then to be explained anew. Of air that is mostly slewing nothing is taken
/// out.
bool dig_slew_leave_out(struct dig_lines *lines, const double at[]);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H
