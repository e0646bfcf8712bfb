// How much the rows of free air scatter, told by themselves. The noise of neighbouring samples says
// it only where noise is white; a valve that hunts or a filtered sensor moves in tenths of a
// second, which blocks average less than they would white noise.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H

#include "closed_loop/machine/machine_lines.h"

/// Multiplies the sigma of all rows of a joint by what its rows scatter, if that is clearly
/// more: 1.48 / sqrt(2) times the median difference of blocks two apart (1.2 times that of
/// neighbours, if less), which slow causes, and those that come or go in few places, leave as it
/// is. Of the rows as they are and with the values at taken off (those that explain most, rightly
/// or not) the smaller counts. True: any sigma has grown.
bool dig_machine_noise_widen(struct dig_lines *lines, const double at[]);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
