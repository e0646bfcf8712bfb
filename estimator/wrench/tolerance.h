// Error of the soil's wrench by the tolerances of a machine (core/machine.h).
//
// The wrench is linear in the moments of drives and weights, whose partials the balance has. The
// levers vary with their pins (differences over one tolerance), the weights with mass and centre
// (exact). Neglected are the bores (H9, a tenth of a per cent of a push), the pins
// between the links (a few millimetres of metres), angles' zeros, inertia.

#ifndef DIG_ESTIMATOR_WRENCH_TOLERANCE_H
#define DIG_ESTIMATOR_WRENCH_TOLERANCE_H

#include "core/machine.h"
#include "estimator/wrench/balance.h"
#include "estimator/wrench/statics.h"

/// Variance of each part. A length by whose tolerance the linkage cannot be solved counts as 0: the
/// pose is within a few millimetres of where there is no wrench anyway. Constant time; nothing to
/// do where all tolerances are 0.
void dig_tolerance_variance(const struct dig_machine *machine, const struct dig_readings *readings,
                            const struct dig_front *front, const struct dig_balance *balance,
                            double variance[DIG_PARTS]);

#endif // DIG_ESTIMATOR_WRENCH_TOLERANCE_H
