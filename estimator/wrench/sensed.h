// The soil's wrench on the bucket by a force sensor that carries it (a rig), with its uncertainty.
//
// Free body of the bucket and all that hangs on the sensor beyond it, mass m at C, inertia I about
// C; Q the bucket's pin, S the sensor's origin; (F_s, M_s) what it reads, turned into the machine
// frame; (F, M) the soil on the bucket, M about Q:
//
//   F_s = F + m (g - a_C)
//   M_s = M + (Q - S) x F + (C - S) x m (g - a_C) - I alpha
//
// Frames and signs as in wrench.h; core/machine.h says what the sensor reads.

#ifndef DIG_ESTIMATOR_WRENCH_SENSED_H
#define DIG_ESTIMATOR_WRENCH_SENSED_H

#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "core/vec2.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/soil_wrench.h"
#include "estimator/wrench/statics.h"

/// Motion of the bucket, machine frame. Zeroed: at rest, known exactly.
struct dig_sensed_motion {
    struct dig_vec2 pin_mps2;
    double          turn_radps;
    double          turn_radps2;
    double          pin_sigma_mps2; // 1 sigma, of each axis
    double          turn_sigma_radps2;
};

/// The motion by the sample's pose and those before it, as by dig_rates_step() for joints: the
/// accelerations are those of the middle of the filter's window. The sample must be one that
/// dig_sensed_solve() takes.
struct dig_sensed_motion dig_sensed_move(struct dig_rates_filter  *filter,
                                         const struct dig_machine *machine,
                                         const struct dig_sample  *sample);

/// Solves one sample of a machine whose sensor is fitted and places the bucket; boom and arm of the
/// front are not there and stay 0. A reading within half a step and three sigmas of the sensor's
/// limits clears moment_valid and force_valid and leaves the wrench 0. A missing pitch counts as 0.
/// DIG_ESTALE: a signal is missing that is needed. DIG_EINVAL: a number that is not finite. Then
/// nothing is written. Constant time.
///
/// sigma: the sensor's, the angle's and the accelerations' errors, all independent, by central
/// differences over one sigma of each (exact but for the angle: all else is linear).
DIG_MUST_CHECK enum dig_status dig_sensed_solve(const struct dig_machine       *machine,
                                                const struct dig_sample        *sample,
                                                const struct dig_sensed_motion *motion,
                                                struct dig_wrench *wrench, struct dig_front *front);

#endif // DIG_ESTIMATOR_WRENCH_SENSED_H
