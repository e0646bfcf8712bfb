// Correlated noise of free air, estimated from its rows. A valve that hunts, a pump that pulses or
// a filtered sensor moves in tenths of a second, which neighbouring samples do not show. Each
// drive's push has noise of its own size; one correlation time, in which it becomes e times less
// alike, holds for all. Sizes and time make the rows likeliest, with the machine's effects
// integrated out by their priors.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H

#include "closed_loop/machine/machine_fit.h"

/// Zeroed: none.
struct dig_machine_noise {
    double sigma_N[DIG_MEASURED_MAX][DIG_JOINTS]; // of each dig's pushes, at the rods; 0: none
    double memory_s;                              // 0: none
    double alone;                                 // variance of a row alone, over that
};

/// Estimates it, with the effects' slopes at these values. It counts for a joint where both the air
/// before digs and the air after them are likelier with it, and where the rows it leaves are not
/// correlated from block to block: a ripple of seconds is no noise. A dig without air gets the mean
/// of the digs. Some tenths of a second.
void dig_machine_noise_tell(struct dig_lines *lines, const double at[],
                            struct dig_machine_noise *noise);

/// Raises the sigma of every row to what the noise leaves of a mean of many rows, as effects are
/// slower than it. True: any sigma has grown.
bool dig_machine_noise_widen(const struct dig_machine_noise *noise, struct dig_air *air);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
