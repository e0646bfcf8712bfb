// Recordings of one dig in one bed, made anew by a simulation with other noise of the sensors or by
// a rig that replays it, are one sample of what beds of a gravel do: their mean is no nearer to the
// gravel's than each of them.

#ifndef DIG_CLOSED_LOOP_FIT_SAME_BED_H
#define DIG_CLOSED_LOOP_FIT_SAME_BED_H

#include "closed_loop/fit/whitened_digs.h"

/// How many beds a group's digs are of, 1 … digs. Two digs of different beds are nearer to each
/// other than those that count as one once in a million pairs.
size_t dig_same_bed_count(const struct dig_whitened_digs *batch, size_t group);

#endif // DIG_CLOSED_LOOP_FIT_SAME_BED_H
