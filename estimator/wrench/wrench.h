// The soil's wrench on the bucket by one sample of a machine with cylinders, with its uncertainty.
//
// Free-body balance of the links beyond each pin, T_j the moment of drive j, G_j of the weights
// beyond pin j, r_j the vector from pin j to the bucket pin, (M, F) the soil on the bucket:
//
//   bucket about its pin     T_bucket + G_bucket + M             = 0
//   arm + bucket             T_arm    + G_arm    + M + r_arm  x F = 0
//   boom + arm + bucket      T_boom   + G_boom   + M + r_boom x F = 0
//
// M is the rig's My: mirroring x and reversing the axis cancel. Fx is minus the
// machine's. The last two equations are dependent when the arm is stretched out.

#ifndef DIG_ESTIMATOR_WRENCH_WRENCH_H
#define DIG_ESTIMATOR_WRENCH_WRENCH_H

#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/soil_wrench.h"
#include "estimator/wrench/statics.h"

/// Below this sine of the angle between r_arm and r_boom the force is not solved: it is
/// ill-conditioned.
#define DIG_WRENCH_MIN_SINE 0.05

/// Solves one sample and places the front. A drive at relief or at its stop, or a linkage at its
/// toggle, clears moment_valid (the bucket's) or force_valid (any) and leaves those numbers 0; the
/// front is placed all the same. A missing pitch counts as 0. Without the boom's or the arm's
/// pressures there is no force; the moment and its sigma are unaffected.
///
/// DIG_ESTALE: an angle or a pressure of the bucket's is missing. DIG_EINVAL: a number that is not
/// finite. Then nothing is written. Constant time: seven solutions of the balance.
///
/// sigma: pressures through the exact linear dependence, angles through central differences over
/// one sigma of the angle, all errors independent; near a toggle or a stretched arm it grows as the
/// partials do. geometry_sigma: estimator/wrench/tolerance.h.
DIG_MUST_CHECK enum dig_status dig_wrench_solve(const struct dig_machine *machine,
                                                const struct dig_sample  *sample,
                                                struct dig_wrench *wrench, struct dig_front *front);

/// What dig_wrench_correct() does besides: sigmas, for three times the work, values and flags being
/// the same to the bit; and the links' inertia subtracted, which needs centred rates.
enum dig_wrench_with { DIG_WITH_SIGMA = 1, DIG_WITH_INERTIA = 2 };

/// The same for a corrected machine: corrected is dig_correction_machine() of the same correction,
/// which may be zero. The front is placed at the time of the pressures, delay_s before the sample's
/// angles. sigma includes the rates' noise through friction and inertia. with: a sum of enum
/// dig_wrench_with.
DIG_MUST_CHECK enum dig_status
dig_wrench_correct(const struct dig_machine *corrected, const struct dig_correction *correction,
                   const struct dig_sample *sample, const struct dig_rates *rates, unsigned with,
                   struct dig_wrench *wrench, struct dig_front *front);

#endif // DIG_ESTIMATOR_WRENCH_WRENCH_H
