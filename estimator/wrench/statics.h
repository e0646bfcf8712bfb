// Pose of the front, and the moments of its weight about the three pins.
//
// Machine frame: origin boom foot, +X forward, +Z up (the y of a dig_vec2), counter-clockwise
// positive. Gravity points along (-sin pitch, -cos pitch): pitch is the angle of machine X against
// the horizontal, nose up positive.
//
// Quasi-static: without the links' inertia, which dynamics.h adds.

#ifndef DIG_ESTIMATOR_WRENCH_STATICS_H
#define DIG_ESTIMATOR_WRENCH_STATICS_H

#include "core/machine.h"
#include "core/vec2.h"

struct dig_front {
    double          attitude_rad[DIG_JOINTS]; // each link's +x against machine X
    struct dig_vec2 pin_m[DIG_JOINTS];        // boom foot (the origin), arm pin, bucket pin
    struct dig_vec2 com_m[DIG_JOINTS];        // each link's centre of mass
};

/// Places the links at the joint angles (boom, arm, bucket). Constant time.
struct dig_front dig_front_place(const struct dig_machine *machine,
                                 const double              joint_rad[DIG_JOINTS]);

/// Where a machine of this pitch is pulled to, by 1 kg.
struct dig_vec2 dig_statics_gravity_mps2(double pitch_rad);

/// Moment about pin j of the weight of every link beyond it: [bucket] the bucket's own weight about
/// the bucket pin, [arm] arm and bucket about the arm pin, [boom] all about the boom foot, Nm.
void dig_statics_weight_Nm(const struct dig_machine *machine, const struct dig_front *front,
                           double pitch_rad, double moment_Nm[DIG_JOINTS]);

#endif // DIG_ESTIMATOR_WRENCH_STATICS_H
