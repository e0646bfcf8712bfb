// Writes the true pose and load beside the sensors' readings, for tests and plots.

#ifndef DIG_TOOLS_RIG_TRUTH_H
#define DIG_TOOLS_RIG_TRUTH_H

#include "core/error.h"
#include "tools/rig/motion/track.h"

/// Writes t_s,X_m,Z_m,phi_rad,Fx_N,Fz_N,My_Nm, one row of the track a line: the bucket pin and the
/// direction pin -> tooth in the machine frame; force and moment of the soil on the bucket at
/// machine scale in the RIG's axes (x towards the cab, My > 0 resists curling). All or nothing:
/// DIG_EIO.
DIG_MUST_CHECK enum dig_status
dig_rig_truth_write(const char *path, const struct dig_rig_track *track, struct dig_error *error);

#endif // DIG_TOOLS_RIG_TRUTH_H
