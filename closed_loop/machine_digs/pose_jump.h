// A joint that is elsewhere from one sample to the next: recordings put together in one file, or a
// sensor that lost its zero. Free air across it shows a motion that no machine made.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_POSE_JUMP_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_POSE_JUMP_H

#include "core/sample.h"

#include <stdbool.h>
#include <stddef.h>

struct dig_pose_jump {
    size_t          before; // the last sample before it
    enum dig_signal signal;
    double          rad;
};

/// True when an angle stays at least .1 rad beyond what 3 rad/s bring it. One wrong sample is no
/// jump. All samples have all angles, in time. *jump is the first; it is untouched otherwise.
bool dig_pose_jump_find(size_t samples, const struct dig_sample sample[],
                        struct dig_pose_jump *jump);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_POSE_JUMP_H
