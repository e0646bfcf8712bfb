// The machine at one instant of the path: joints and pressures, and how near it is to what a real
// machine could not do.

#ifndef DIG_TOOLS_RIG_MOTION_STATE_H
#define DIG_TOOLS_RIG_MOTION_STATE_H

#include "core/machine.h"
#include "tools/rig/motion/gauge.h"

#include <stddef.h>

/// What can stop a dig, in the order of the messages.
enum dig_rig_limit {
    DIG_RIG_LIMIT_JOINT,  // angle out of its range
    DIG_RIG_LIMIT_STROKE, // cylinder shorter or longer than it is
    DIG_RIG_LIMIT_LEVER,  // cylinder without leverage
    DIG_RIG_LIMIT_RELIEF, // pressure at its relief valve
    DIG_RIG_LIMIT_LIFT,   // soil pushes up more than everything weighs
    DIG_RIG_LIMIT_TIP,    // the machine turns over an edge of its tracks
    DIG_RIG_LIMIT_SENSOR  // load on a force sensor
};

/// The nearest limit. share is what is left of it, 1 (all) to 0 (at it), negative beyond.
struct dig_rig_margin {
    double             share;
    enum dig_rig_limit limit;
    enum dig_joint     joint; // of JOINT, STROKE, LEVER, RELIEF
    double             value; // what was reached …
    double             bound; // … and what is allowed, in the limit's unit
    const char        *end;   // "head", "rod"; "front", "rear"; "Fx", "Fz", "My"
};

struct dig_rig_state {
    struct dig_rig_joints    joints;
    struct dig_rig_pressures pressures;
    struct dig_rig_load      load;    // of a machine with a force sensor, which has nothing above
    struct dig_rig_margin    nearest; // of all limits
    struct dig_rig_margin    mechanical; // of joints, strokes and levers only
};

/// Solves one pose. motion: see work.h. DIG_EUNREACHABLE when the pose is out of the linkage's
/// reach; a limit that is exceeded is no failure here, its share is negative.
///
/// Shares: joint and stroke, distance to the nearer end over the range; lever, |dL/dq| over its
/// mean (stroke / range) less a tenth; relief, 1 - p / relief, and a sensor's alike; lift, vertical
/// reaction of the ground over weight; tip, moment that still holds the machine about the edge over
/// what it is without the front.
DIG_MUST_CHECK enum dig_status dig_rig_state_solve(const struct dig_machine    *machine,
                                                   const struct dig_rig_pose   *pose,
                                                   const struct dig_rig_motion *motion,
                                                   const struct dig_rig_wrench *soil,
                                                   struct dig_rig_state        *state);

/// A sentence for the person whose dig is refused: what, its peak and its limit. Never NULL;
/// written into text, which is returned.
const char *dig_rig_margin_text(const struct dig_rig_margin *margin, size_t size, char text[]);

#endif // DIG_TOOLS_RIG_MOTION_STATE_H
