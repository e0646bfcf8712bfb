// A machine as free air leaves it open, as steps of a fit to the digs: the gain of a pressure
// sensor, say, reads little in free air and much in a dig.
//
//   y(dig) = soil(dig) + middle(dig) + sum over k of z[k] D[k](dig),    z ~ N(0, 1)
//
// middle is what an answer's values add to a dig, D what a step from there adds
// (closed_loop/machine/machine_side.h). Gravel, effects of the soil and z are then one fit:
// closed_loop/fit/likelihood.h.

#ifndef DIG_CLOSED_LOOP_VERDICT_MACHINE_STEPS_H
#define DIG_CLOSED_LOOP_VERDICT_MACHINE_STEPS_H

#include "closed_loop/verdict/trace_work.h"

/// Leaves in w->measured[].machine what the answer's values add to every dig, and in *steps what
/// its steps from there add to the mean dig of each of the batch's trajectories. DIG_ENOMATCH: a
/// dig is not told with the effects. DIG_ENOMEM. Some milliseconds a parameter.
DIG_MUST_CHECK enum dig_status dig_machine_steps_make(const struct dig_trace_work     *w,
                                                      const struct dig_machine_answer *answer,
                                                      struct dig_steps                *steps);

/// Writes values and 90 % intervals of the answer's parameters: at z, whose covariance is
/// [numbers * numbers] (NULL: the values alone).
void dig_machine_steps_values(const double z[], const double covariance[],
                              struct dig_machine_answer *answer);

#endif // DIG_CLOSED_LOOP_VERDICT_MACHINE_STEPS_H
