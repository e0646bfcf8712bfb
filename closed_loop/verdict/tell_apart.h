// Which dig or which motion in free air would tell apart what a campaign's digs cannot: how far the
// candidates as they were fitted differ along each, in units of its noise.

#ifndef DIG_CLOSED_LOOP_VERDICT_TELL_APART_H
#define DIG_CLOSED_LOOP_VERDICT_TELL_APART_H

#include "closed_loop/verdict/trace_work.h"

/// Fills tells for every pair of every set of a trace, as many as there is room for. Effects of the
/// soil are compared along the table's trajectories, dug as they are, at twice the pace, where one
/// was dug before and by a tooth that has dug ten more; effects of the machine (w->machine not
/// NULL) in motions in free air (closed_loop/machine/machine_motion.h) and in the digs that were
/// recorded. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_tell_apart(const struct dig_trace_work *w,
                                              struct dig_trace            *trace);

/// "A and B differ most …" as a sentence without its stop, of at most size - 1 characters.
void dig_tell_apart_say(const struct dig_tell_apart *tell, size_t size, char text[]);

#endif // DIG_CLOSED_LOOP_VERDICT_TELL_APART_H
