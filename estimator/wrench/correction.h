// The correction: everything in which a machine may differ from its file. Zeroed: no difference.
//
// The closed loop estimates it in free air (closed_loop/machine/machine_side.h), a model file holds
// it, dig_wrench_correct() applies it. Signs: file's value + correction = machine's value; a sensor
// reads offset + (1 + gain) * pressure.

#ifndef DIG_ESTIMATOR_WRENCH_CORRECTION_H
#define DIG_ESTIMATOR_WRENCH_CORRECTION_H

#include "core/machine.h"
#include "core/status.h"

#include <stdbool.h>

enum dig_chamber { DIG_CHAMBER_HEAD, DIG_CHAMBER_ROD, DIG_CHAMBERS };

/// Friction of one drive, between piston and bore: loss of push, against the rod's motion.
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

/// Width of the transition about standstill, where the direction of friction is not defined, m/s.
#define DIG_FRICTION_STILL_mps 0.003

/// Mass in or on a link beyond the file's. With mass_kg alone it lies in the file's centre of
/// mass and leaves the inertia about the centre unchanged.
struct dig_added_mass {
    double          mass_kg;
    struct dig_vec2 moment_kgm;   // mass times distance from the file's centre, the link's frame
    double          inertia_kgm2; // about the centre of mass of all
};

struct dig_correction {
    struct dig_friction   friction[DIG_JOINTS];
    double                offset_Pa[DIG_JOINTS][DIG_CHAMBERS];
    double                gain[DIG_JOINTS][DIG_CHAMBERS];
    struct dig_added_mass link[DIG_JOINTS]; // of the links themselves: every dig
    struct dig_added_mass payload;          // carried over from the dig before: this dig only
    // Geometry: added to the file's lengths and places.
    double          rocker_m, link_m;
    struct dig_vec2 rocker_pin_m, ear_m;
    struct dig_vec2 base_m[DIG_JOINTS], eye_m[DIG_JOINTS]; // eye: boom and arm only
    double          angle_rad[DIG_JOINTS]; // that the sensor reads more than the joint's angle
    double          level_rad;             // that the machine is pitched more than it says
    double          delay_s; // by which pressures are later than the angles beside them
};

/// The machine with its geometry and its links corrected; a payload is part of its bucket.
struct dig_machine dig_correction_machine(const struct dig_machine    *machine,
                                          const struct dig_correction *correction);

/// True when it moves a pin or makes a bar longer or shorter.
bool dig_correction_is_geometric(const struct dig_correction *correction);

/// Restores the file's geometry in a machine of dig_correction_machine(): the file's lengths of a
/// cylinder at its stops hold there.
struct dig_machine dig_correction_drawn(const struct dig_machine    *corrected,
                                        const struct dig_correction *correction);

/// A machine with its correction: made off the tick, copied in it.
struct dig_corrected_machine {
    bool                  corrects; // false: the machine as its file says; the rest is zero
    struct dig_correction correction;
    struct dig_machine    machine; // corrected
};

/// Makes it; of a zeroed correction the machine as its file says. Nothing is written otherwise:
/// DIG_EINVAL: a number that is not finite; a gain of -1 or less; a corrected machine that fails
/// dig_machine_check(); a rig with a force sensor, for which no correction is defined.
/// DIG_EUNREACHABLE: its linkage does not close over its range. About a millisecond.
DIG_MUST_CHECK enum dig_status dig_correction_apply(const struct dig_machine     *machine,
                                                    const struct dig_correction  *correction,
                                                    struct dig_corrected_machine *corrected);

#endif // DIG_ESTIMATOR_WRENCH_CORRECTION_H
