// One fit of the machine and the gravel to free air and the digs together: the gain of a pressure
// sensor, say, reads little in free air and much in a dig.
//
//   y(dig) = plain(gravel) + sum over k of z[k] D[k](dig),    z ~ N(0, 1)
//
// Free air's answer is the prior of z (closed_loop/machine/machine_side.h); D is what a step of it
// adds to a dig. Gravel and z are fitted to the means of the digs, weighed as hypothesis.h does, by
// Gauss-Newton; Laplace's evidence of the digs counts what of the prior they leave.

#ifndef DIG_CLOSED_LOOP_VERDICT_JOINT_FIT_H
#define DIG_CLOSED_LOOP_VERDICT_JOINT_FIT_H

#include "closed_loop/machine/machine_side.h"
#include "closed_loop/model/hypothesis.h"

/// The answer's effects as free air and the digs have them: values and 90 % intervals of *fitted,
/// and the log of what the step from free air's values costs beside the digs' likelihood at the new
/// ones (<= 0). plain: the gravel fitted to the batch with measured[].machine taken off.
/// DIG_ENOMATCH: a dig is not told with the effects. DIG_ENOMEM. Some milliseconds a parameter.
DIG_MUST_CHECK enum dig_status
dig_joint_fit(struct dig_machine_side *machine, const struct dig_machine_answer *answer,
              size_t digs, const struct dig_measured measured[],
              const struct dig_whitened_digs *batch, const struct dig_soil *soil,
              const struct dig_fitted *plain, struct dig_machine_answer *fitted, double *log_cost);

#endif // DIG_CLOSED_LOOP_VERDICT_JOINT_FIT_H
