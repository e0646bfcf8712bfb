// The excavator front as geometry: where the pins and masses are at given joint angles, which
// joint angles put the bucket pin where it is wanted, and how long the cylinders are there.
// No force appears here; the rig takes its forces from derivatives of these lengths and places.
//
// Machine frame (core/machine.h): origin boom foot, +X forward, +Z up, angles counter-clockwise.
// A rig's +x is the machine's -X, so a bucket attitude theta of the rig is phi = -pi/2 - theta.

#ifndef DIG_TOOLS_RIG_MOTION_MECHANISM_H
#define DIG_TOOLS_RIG_MOTION_MECHANISM_H

#include "core/machine.h"
#include "core/status.h"
#include "core/vec2.h"

/// Joint angles in the order of enum dig_joint: boom, arm, bucket.
struct dig_rig_joints {
    double rad[DIG_JOINTS];
};

/// Where the bucket is: its pin in the machine frame and the direction pin -> tooth.
struct dig_rig_pose {
    double X_m, Z_m, phi_rad;
};

/// Where all of the front is, machine frame.
struct dig_rig_front {
    double              attitude_rad[DIG_JOINTS]; // of a link's +x against machine X
    struct dig_vec2     com_m[DIG_JOINTS];
    struct dig_rig_pose bucket;
};

struct dig_rig_front dig_rig_front_at(const struct dig_machine    *machine,
                                      const struct dig_rig_joints *joints);

/// That of a bucket which a force sensor carries there; it has no other links.
struct dig_rig_front dig_rig_front_carried(const struct dig_machine  *machine,
                                           const struct dig_rig_pose *pose);

/// Where a point of the bucket's frame is.
struct dig_vec2 dig_rig_on_bucket(const struct dig_rig_pose *pose, struct dig_vec2 at_m);

/// The joint angles of a pose, with the arm pin above the line boom foot - bucket pin, which is the
/// only side an excavator's arm can be on. DIG_EUNREACHABLE when the pin is out of reach, or nearer
/// to the boom foot than the links allow. Joint limits are not looked at.
DIG_MUST_CHECK enum dig_status dig_rig_inverse(const struct dig_machine  *machine,
                                               const struct dig_rig_pose *pose,
                                               struct dig_rig_joints     *joints);

/// Pin-to-pin length of one drive's cylinder at its joint's angle, m: it depends on no other joint.
/// For the bucket the four-bar is closed with M on the +y side of N-K. DIG_EUNREACHABLE when the
/// four-bar cannot close.
DIG_MUST_CHECK enum dig_status dig_rig_cylinder_m(const struct dig_machine *machine,
                                                  enum dig_joint joint, double angle_rad,
                                                  double *length_m);

/// dL/dq of one drive, m/rad: central difference of dig_rig_cylinder_m() over +-1e-5 rad.
/// Truncation and round-off stay below 1e-9 m/rad for machines of metres.
DIG_MUST_CHECK enum dig_status dig_rig_lever_m(const struct dig_machine *machine,
                                               enum dig_joint joint, double angle_rad,
                                               double *lever_m);

#endif // DIG_TOOLS_RIG_MOTION_MECHANISM_H
