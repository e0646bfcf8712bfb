// Places the dig in front of the machine: the start of the pin with the largest margin.

#ifndef DIG_TOOLS_RIG_MOTION_PLACEMENT_H
#define DIG_TOOLS_RIG_MOTION_PLACEMENT_H

#include "core/error.h"
#include "core/machine.h"
#include "tools/rig/motion/path.h"
#include "tools/rig/motion/state.h"

struct dig_rig_placement {
    double                X_m, Z_m; // the pin at the first dig's first row, machine frame
    struct dig_rig_margin margin;   // the least over the path, quasi-static
};

/// Tries every pin start of a fixed grid (X in hundredths of boom + arm; the dug surface at the
/// tracks' ground and up to 1 m below or above it) and takes the one whose smallest share
/// (state.h) over the whole path is largest; 5 % is taken off per metre that the dug surface
/// lies off the tracks' ground. Deterministic; a second or less. The margin returned may be
/// negative: then the machine has the reach but not the force or the weight, and it says which at
/// the best place. DIG_EUNREACHABLE when no place has every pose within reach of the linkage and
/// within the ranges of joints and cylinders; *error then says what stops the best one.
DIG_MUST_CHECK enum dig_status dig_rig_placement_find(const struct dig_machine  *machine,
                                                      const struct dig_rig_path *path,
                                                      struct dig_rig_placement  *placement,
                                                      struct dig_error          *error);

#endif // DIG_TOOLS_RIG_MOTION_PLACEMENT_H
