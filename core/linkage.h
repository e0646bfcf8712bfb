// The moment of a cylinder's push about the joint it turns: the pin-to-pin cylinders of boom and
// arm, and the bucket's four-bar.
//
//     G------------------M          G  cylinder base pin, on the arm
//                      /   \        N  rocker pin, on the arm
//    ====== arm ======N     K       Q  bucket pin, at (arm length, 0) of the arm frame
//                      \   /        M  rod eye, where cylinder, rocker N-M and link M-K meet
//     +x ->    +y ^      Q          K  link pin, on the bucket; Q-K is the bucket's ear
//
// Frames and signs of core/machine.h: counter-clockwise is positive, so a rod that pushes curls the
// bucket with a NEGATIVE moment. The bars are massless and the pins frictionless: what the rod does
// along its stroke, the joint does along its angle.

#ifndef DIG_CORE_LINKAGE_H
#define DIG_CORE_LINKAGE_H

#include "core/machine.h"
#include "core/status.h"

/// Below this distance between M and the line N-K the linkage is at its toggle: the moment arm
/// diverges, and an error in the angle sensor grows with it.
#define DIG_LINKAGE_TOGGLE_MARGIN_m 0.010

struct dig_lever {
    double length_m; // pin to pin, which a stroke sensor can be checked against
    double arm_m;    // moment about the joint per unit push, Nm/N; counter-clockwise positive
};

/// The bucket linkage solved at one angle, arm frame.
struct dig_linkage_pose {
    struct dig_vec2  rod_eye_m;  // M
    struct dig_vec2  link_pin_m; // K
    struct dig_lever lever;      // about Q
};

/// Nothing to refuse where a force sensor carries the bucket: it has no linkage.
///
/// DIG_EUNREACHABLE unless the four-bar closes with margin over the bucket's whole range, and boom
/// and arm cylinders have some length there; of a file dig_geometry_check() says where not. Call
/// once, after dig_machine_check(): the solvers trust the geometry. About a millisecond.
DIG_MUST_CHECK enum dig_status dig_linkage_check(const struct dig_machine *machine);

/// Solves the four-bar at bucket_rad (against the arm), with M on the +y side of the line from N to
/// K. DIG_EINVAL if the angle is not finite, DIG_EUNREACHABLE if the bars cannot close or stand
/// within DIG_LINKAGE_TOGGLE_MARGIN_m of the toggle. Constant time.
DIG_MUST_CHECK enum dig_status dig_linkage_solve(const struct dig_machine *machine,
                                                 double bucket_rad, struct dig_linkage_pose *pose);

/// The lever of any of the three drives at its joint's angle. Fails as dig_linkage_solve() does; a
/// cylinder without length is unreachable. Constant time.
DIG_MUST_CHECK enum dig_status dig_lever_solve(const struct dig_machine *machine,
                                               enum dig_joint joint, double angle_rad,
                                               struct dig_lever *lever);

#endif // DIG_CORE_LINKAGE_H
