// Everything in which a machine may differ from its file. Zeroed it is the machine as the file
// says.
//
// The closed loop finds these in free air (closed_loop/machine_side.h), a model file carries them,
// dig_wrench_correct() takes them off. Signs are those of the truth: what is added to the file's
// value gives the machine's own, and what a sensor reads is offset + (1 + gain) * pressure.

#ifndef DIG_ESTIMATOR_CORRECTION_H
#define DIG_ESTIMATOR_CORRECTION_H

#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/estimator.h"
#include "estimator/rates.h"
#include "estimator/statics.h"

enum dig_chamber { DIG_CHAMBER_HEAD, DIG_CHAMBER_ROD, DIG_CHAMBERS };

/// Between piston and bore of one whole drive: what is lost of the push, against the rod's motion.
///
///   loss = [ coulomb + stribeck exp(-|v| / stribeck_mps) + load_share |push| ] tanh(v / still_mps)
///          + viscous v
struct dig_friction {
    double coulomb_N;
    double viscous_Nspm;
    double stribeck_N; // more at a crawl; 0 with stribeck_mps 0
    double stribeck_mps;
    double load_share; // of the push that the pressures make
};

/// Below this speed of the rod the direction of friction is not told, m/s.
#define DIG_FRICTION_STILL_mps 0.003

/// A body more than the file's bucket, in the bucket's frame; its inertia about its own centre.
struct dig_burden {
    double          mass_kg;
    struct dig_vec2 moment_kgm;   // mass times its centre's place
    double          inertia_kgm2; // about the bucket pin
};

struct dig_correction {
    struct dig_friction friction[DIG_JOINTS];
    double              offset_Pa[DIG_JOINTS][DIG_CHAMBERS];
    double              gain[DIG_JOINTS][DIG_CHAMBERS];
    struct dig_burden   bucket;  // of the bucket itself: every dig
    struct dig_burden   payload; // carried over from the dig before: this dig only
    // Geometry: added to the file's lengths and places.
    double          rocker_m, link_m;
    struct dig_vec2 rocker_pin_m, ear_m;
    struct dig_vec2 base_m[DIG_JOINTS], eye_m[DIG_JOINTS]; // eye: boom and arm only
    double          delay_s; // by which pressures are later than the angles beside them
};

/// True when it changes nothing.
bool dig_correction_is_none(const struct dig_correction *correction);

/// DIG_EINVAL: a number that is not finite, a gain of -1 or less, or a machine that is none any
/// more with it (dig_machine_check() and the linkage's closing over its range). About a
/// millisecond.
DIG_MUST_CHECK enum dig_status dig_correction_check(const struct dig_machine    *machine,
                                                    const struct dig_correction *correction);

/// The machine with its geometry and its bucket corrected; a payload is part of its bucket.
struct dig_machine dig_correction_machine(const struct dig_machine    *machine,
                                          const struct dig_correction *correction);

/// What remains of the joints' balance in free air, Nm: drives, weights and inertia about each pin.
/// 0 when the machine is as corrected and nothing touches the bucket; the soil's moments
/// otherwise. corrected: dig_correction_machine() of the same. Fails as dig_wrench_solve(), and
/// DIG_EUNREACHABLE where a linkage does not close.
DIG_MUST_CHECK enum dig_status dig_correction_balance(const struct dig_machine    *corrected,
                                                      const struct dig_correction *correction,
                                                      const struct dig_sample     *sample,
                                                      const struct dig_rates      *rates,
                                                      double moment_Nm[DIG_JOINTS]);

/// dig_wrench_solve() of the machine as corrected, inertia taken off. The front is where it was
/// when the pressures were: delay_s before the sample's angles. Fails as dig_wrench_solve(). sigma
/// also holds what the rates' noise does through friction and inertia.
DIG_MUST_CHECK enum dig_status
dig_wrench_correct(const struct dig_machine *corrected, const struct dig_correction *correction,
                   const struct dig_sample *sample, const struct dig_rates *rates,
                   struct dig_wrench *wrench, struct dig_front *front);

#endif // DIG_ESTIMATOR_CORRECTION_H
