// Slewing while free air is recorded, which no recording tells. Masses are pulled outward by
// omega^2 times how far from the slew axis they are, here the boom pin; nothing of a machine or its
// sensors pulls so at one time and not at another. Nor does any hold a standing bucket up as does
// ground that it rests on, higher than where it digs: by a force upward and a moment about its pin.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H

#include "closed_loop/machine/machine_fit.h"

#include <stdbool.h>

/// What is asked for: either pull for a second or more, which noise that lasts does not make; or
/// the ground alone, touched for a fifth of a second or more, where such noise is in the rows'
/// sigmas.
enum dig_slew { DIG_SLEW_LONG, DIG_SLEW_TOUCHES };

/// Takes out of the air all rows that long in which such a pull, with one size, explains most of
/// what the values at (those that explain most) leave, and clearly. True: any went; what is left is
/// then to be explained anew. Of air that is mostly such nothing is taken out.
bool dig_slew_leave_out(struct dig_lines *lines, const double at[], enum dig_slew which);

/// The rows that air has, to go back to, in room for as many.
struct dig_slew_rows {
    struct dig_air_row *row;
    size_t              rows;
    size_t              of[DIG_LINES_SEGMENTS_MAX]; // how many each segment has
};

void dig_slew_rows_save(const struct dig_air *air, struct dig_slew_rows *rows);
void dig_slew_rows_restore(const struct dig_slew_rows *rows, struct dig_air *air);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SLEW_H
