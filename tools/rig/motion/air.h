// A motion in free air in which every joint is moved: what the file of a new machine is checked
// with. A person would do the same with the levers.
//
//   stand | boom down, up, back | arm in, out, back | bucket in, out, back | all three, four poses
//
// Each joint goes through the middle 70 % of its range, the others held in the middle of theirs; no
// faster than 0.5 rad/s, at rest for half a second between two moves.

#ifndef DIG_TOOLS_RIG_MOTION_AIR_H
#define DIG_TOOLS_RIG_MOTION_AIR_H

#include "core/error.h"
#include "core/machine.h"
#include "tools/rig/motion/path.h"

/// The motion in the machine frame, without soil; about a minute. DIG_EINVAL for a rig with a force
/// sensor, whose bucket has no joints; DIG_ENOMEM. Free with dig_rig_path_finish().
DIG_MUST_CHECK enum dig_status dig_rig_air_build(const struct dig_machine *machine,
                                                 struct dig_rig_path      *path,
                                                 struct dig_error         *error);

#endif // DIG_TOOLS_RIG_MOTION_AIR_H
