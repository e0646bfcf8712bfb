// What a machine that free air leaves partly undetermined adds to the digs, linear in z:
//
//   y(dig) = soil(dig) + sum over k of z[k] of[k](trajectory),    z ~ N(middle, 1)

#ifndef DIG_CLOSED_LOOP_FIT_STEPS_H
#define DIG_CLOSED_LOOP_FIT_STEPS_H

#include "closed_loop/fit/batch.h"

#define DIG_STEPS_MAX 42

struct dig_steps {
    size_t steps;
    double middle[DIG_STEPS_MAX];
    double of[DIG_STEPS_MAX][DIG_TRAJECTORY_MAX][DIG_FEATURES]; // units of the table
};

/// Adds sum z[k] of[k] to y of a group, whitened. Does nothing without steps.
void dig_steps_add(const struct dig_batch *batch, const double z[], size_t group,
                   double y[DIG_FEATURES]);

/// Subtracts sum z[k] of[k] from the batch's digs, which have no steps then.
void dig_steps_settle(struct dig_batch *batch, const double z[]);

#endif // DIG_CLOSED_LOOP_FIT_STEPS_H
