// Noise of free air that lasts, told by the rows themselves: a valve that hunts, a pump that
// pulses or a filtered sensor moves in tenths of a second, and the noise of neighbouring samples
// does not show it. Every drive's push is off by a number of its own size that becomes e times less
// alike in one time for all; sizes and time are those that make the rows likeliest, whatever
// effects the machine has: these are integrated out by their priors.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H

#include "closed_loop/machine/machine_lines.h"

/// Noise that lasts.
struct dig_machine_noise {
    double sigma_N[DIG_MEASURED_MAX][DIG_JOINTS]; // of each dig's pushes, at the rods; 0: none
    double memory_s;                              // 0: none
    double alone;                                 // variance of a row alone, over that
};

/// Tells it, the effects' slopes taken at these values. It counts for a joint where the air before
/// digs is likelier with it, and that after them, and where it leaves rows that are not alike from
/// block to block: a ripple of seconds is no noise. A dig without air has the digs' mean.
/// DIG_ENOMEM. Some tenths of a second.
DIG_MUST_CHECK enum dig_status dig_machine_noise_tell(struct dig_lines *lines, const double at[],
                                                      struct dig_machine_noise *noise);

/// Tells it so and makes the sigma of every row what the noise does to a mean of many rows, as
/// effects are slower than it. True: any sigma has grown.
bool dig_machine_noise_widen(struct dig_lines *lines, const double at[]);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_NOISE_H
