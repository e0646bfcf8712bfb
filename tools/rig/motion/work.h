// Virtual work: which cylinder forces hold the front still (or move it as it moves) under the soil,
// the links' weights and their inertia.
//
// For every joint q_j the work of all forces over a small turn dq_j is zero:
//
//   S_j * dL_j/dq_j  +  sum over links ( F_k . dr_k/dq_j + M_k dphi_k/dq_j )  +  soil . d(pin)/dq_j
//   = 0
//
// with S_j the push of drive j (positive when the rod pushes), L_j its cylinder's length, r_k a
// link's centre of mass, F_k = m_k (g - a_k), M_k = -I_k alpha_k (d'Alembert). Every derivative is
// a central difference of the mechanism's own places and lengths: no statics, no lever arms.

#ifndef DIG_TOOLS_RIG_MOTION_WORK_H
#define DIG_TOOLS_RIG_MOTION_WORK_H

#include "core/machine.h"
#include "tools/rig/motion/mechanism.h"

#define DIG_RIG_GRAVITY_mps2 9.81

/// Soil on bucket, at the bucket pin, machine frame: FX forward, FZ up, moment counter-clockwise.
struct dig_rig_wrench {
    double FX_N, FZ_N, M_Nm;
};

/// How a link moves: acceleration of its centre of mass and of its attitude. Zero: quasi-static.
struct dig_rig_motion {
    struct dig_vec2 com_mps2[DIG_JOINTS];
    double          turn_radps2[DIG_JOINTS];
};

/// Push of each whole drive (all `count` cylinders together), N.
struct dig_rig_pushes {
    double N[DIG_JOINTS];
};

/// Pressures of the six chambers, Pa.
struct dig_rig_pressures {
    double head_Pa[DIG_JOINTS], rod_Pa[DIG_JOINTS];
};

/// Work of soil, weights and inertia as the front goes from one place to another nearby.
double dig_rig_work_J(const struct dig_machine *machine, const struct dig_rig_motion *motion,
                      const struct dig_rig_wrench *soil, const struct dig_rig_front *from,
                      const struct dig_rig_front *to);

/// DIG_EUNREACHABLE where a cylinder has no leverage (|dL/dq| below 1 mm/rad) or the four-bar does
/// not close.
DIG_MUST_CHECK enum dig_status dig_rig_work_solve(const struct dig_machine    *machine,
                                                  const struct dig_rig_joints *joints,
                                                  const struct dig_rig_motion *motion,
                                                  const struct dig_rig_wrench *soil,
                                                  struct dig_rig_pushes       *pushes);

/// Chamber pressures that give these pushes with back_Pa in the return side. Pushing, the head
/// carries (push / count + back annulus) / head area and the rod side holds back_Pa; pulling, the
/// rod side carries and the head holds back_Pa. The switch lies at push = count * back_Pa * (head
/// area - annulus), where both sides are at back_Pa: continuous there, never below back_Pa.
void dig_rig_work_pressures(const struct dig_machine *machine, const struct dig_rig_pushes *pushes,
                            struct dig_rig_pressures *pressures);

#endif // DIG_TOOLS_RIG_MOTION_WORK_H
