// Force error from unmodelled inertia: the balance is quasi-static, and the bucket accelerates at
// the corners of its path. The effect on the moment about the bucket's pin is negligible
// (docs/numerics/match.md).

#ifndef DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H
#define DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H

#include "core/machine.h"
#include "core/observation.h"

/// Adds the error to the sigmas of both forces, in quadrature. lambda as in dig_estimator_init().
/// Does nothing for a dig without forces.
void dig_inertia_error_add(const struct dig_machine *machine, double lambda,
                           struct dig_observation *dig);

#endif // DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H
