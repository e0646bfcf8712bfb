// The balance of moments about the three pins at one instant. wrench.c makes a wrench of it; in
// free air it must be zero.

#ifndef DIG_ESTIMATOR_WRENCH_BALANCE_H
#define DIG_ESTIMATOR_WRENCH_BALANCE_H

#include "core/linkage.h"
#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/cylinder.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/soil_wrench.h"
#include "estimator/wrench/statics.h"

/// The readings of a sample, by joint. friction and rates may be NULL: none. inertia: the links'
/// masses move at these rates; else they rest.
struct dig_readings {
    double                     joint_rad[DIG_JOINTS];
    double                     pitch_rad;
    struct dig_push            push[DIG_JOINTS];
    const struct dig_friction *friction; // [DIG_JOINTS]
    const struct dig_rates    *rates;
    bool                       inertia;
};

/// One solution. rest_Nm: drive, weight and inertia about each pin; minus the soil's moment there.
/// Partials by the drives' moments. What could not be solved is 0.
struct dig_balance {
    double           part[DIG_PARTS]; // My, Fx, Fz of the soil, rig axes
    double           by_moment[DIG_PARTS][DIG_JOINTS];
    double           rest_Nm[DIG_JOINTS];
    struct dig_lever lever[DIG_JOINTS];
    bool             lever_ok[DIG_JOINTS];
    bool             moment_ok, force_ok;
};

/// Converts a sample; a correction (NULL: none) is applied to its readings first. A drive that
/// lacks a pressure has push 0 and is not valid. DIG_ESTALE, DIG_EINVAL as dig_wrench_solve().
/// rates: NULL only without correction; with them the masses move.
DIG_MUST_CHECK enum dig_status dig_readings_take(const struct dig_machine    *machine,
                                                 const struct dig_correction *correction,
                                                 const struct dig_sample     *sample,
                                                 const struct dig_rates      *rates,
                                                 struct dig_readings         *readings);

/// Friction loss of a drive's push at this speed of the rod, N; against the motion.
double dig_friction_loss_N(const struct dig_friction *friction, double push_N, double rod_mps);

/// Solves. With inertia rates must not be NULL. Constant time.
struct dig_balance dig_balance_solve(const struct dig_machine  *machine,
                                     const struct dig_readings *readings,
                                     const struct dig_front    *front);

/// Adds to variance what accelerations of the joints, each in error by 1 sigma, make of every part
/// through the links' inertia. balance: of that front.
void dig_balance_add_inertia_variance(const struct dig_machine *machine,
                                      const struct dig_front   *front,
                                      const struct dig_balance *balance, double sigma_radps2,
                                      double variance[DIG_PARTS]);

/// Whether the pose determines the force: boom and arm not in one line.
bool dig_balance_gives_force(const struct dig_front *front);

#endif // DIG_ESTIMATOR_WRENCH_BALANCE_H
