// What the forces of a dig may be wrong by beyond what their sensors say: the balance that tells
// them is quasi-static, and a bucket gathers and loses speed at the corners of its path. The moment
// about the bucket's pin hardly minds (docs/numerics/estimator.md).

#ifndef DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H
#define DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H

#include "core/machine.h"
#include "estimator/track/observation.h"

/// Adds to the sigmas of both forces, in quadrature, what the inertia of the machine's links may
/// add to a force told without it. lambda as in dig_estimator_init(). Nothing when the dig has no
/// forces.
void dig_inertia_error_add(const struct dig_machine *machine, double lambda,
                           struct dig_observation *dig);

#endif // DIG_ESTIMATOR_TRACK_INERTIA_ERROR_H
