// Moments of the front's own masses about the joints: weight and inertia, by recursive
// Newton-Euler.
//
// Outward from the boom foot, which is at rest: attitude rates of each link and accelerations of
// its pin and centre of mass. Inward from the bucket: the force F_j and moment N_j that the links
// before pin j exert on those beyond it,
//
//   F_j = m_j (a_j - g) + F_{j+1}
//   N_j = I_j alpha_j + (com_j - pin_j) x m_j (a_j - g) + N_{j+1} + (pin_{j+1} - pin_j) x F_{j+1}
//
// (Luh, Walker & Paul 1980). What is returned is -N_j, the moment the masses themselves exert about
// pin j, as dig_statics_weight_Nm() does; without rates it is that. Frame and signs: statics.h.

#ifndef DIG_ESTIMATOR_WRENCH_DYNAMICS_H
#define DIG_ESTIMATOR_WRENCH_DYNAMICS_H

#include "core/machine.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/statics.h"

/// Moment about each pin of weight and inertia of every link beyond it, Nm. The machine itself
/// stands still. Constant time.
void dig_dynamics_Nm(const struct dig_machine *machine, const struct dig_front *front,
                     const struct dig_rates *rates, double pitch_rad, double moment_Nm[DIG_JOINTS]);

/// The front's inertia matrix in joint coordinates: by[j][k] is the moment about pin j for one
/// rad/s2 of joint k, kgm2; symmetric. Constant time.
void dig_dynamics_inertia_kgm2(const struct dig_machine *machine, const struct dig_front *front,
                               double by[DIG_JOINTS][DIG_JOINTS]);

#endif // DIG_ESTIMATOR_WRENCH_DYNAMICS_H
