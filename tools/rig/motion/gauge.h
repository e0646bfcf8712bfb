// The reading of a force sensor that carries the bucket, by virtual work: soil, weight and inertia.
//
// For a small displacement along the sensor's x, along its z, or a turn about its origin, the work
// of all forces on the bucket is the work on the sensor:
//
//   read . d = soil . d(pin) + M dphi + m (g - a) . d(com) - I alpha dphi
//
// Every displacement is a central difference of where the bucket is: no lever, no balance.

#ifndef DIG_TOOLS_RIG_MOTION_GAUGE_H
#define DIG_TOOLS_RIG_MOTION_GAUGE_H

#include "core/machine.h"
#include "tools/rig/motion/work.h"

/// In the sensor's own frame (core/machine.h).
struct dig_rig_load {
    double Fx_N, Fz_N, My_Nm;
};

/// The load on the sensor of a machine that has one. motion: the bucket's alone counts. Cannot
/// fail.
struct dig_rig_load dig_rig_gauge_read(const struct dig_machine    *machine,
                                       const struct dig_rig_pose   *pose,
                                       const struct dig_rig_motion *motion,
                                       const struct dig_rig_wrench *soil);

#endif // DIG_TOOLS_RIG_MOTION_GAUGE_H
