// Outputs of digrig for a run of the machine: a machine recording, or a run on real buses, in time.

#ifndef DIG_TOOLS_RIG_COMMANDS_H
#define DIG_TOOLS_RIG_COMMANDS_H

#include "core/error.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/options.h"

/// The track as options->out, all that the sensors read along it; and where options->truth is given
/// t_s,X_m,Z_m,phi_rad,Fx_N,Fz_N,My_Nm, one row of the track a line: the bucket pin and the
/// direction pin -> tooth in the machine frame; force and moment of the soil on the bucket at
/// machine scale in the RIG's axes (x towards the cab, My > 0 resists curling). DIG_EIO,
/// DIG_ENOMEM; then no file of ours is left half written.
DIG_MUST_CHECK enum dig_status dig_rig_record(const struct dig_machine     *machine,
                                              const struct dig_rig_options *options,
                                              const struct dig_rig_track   *track,
                                              struct dig_error             *error);

/// Opens every bus asked for, plays the track against absolute deadlines of CLOCK_MONOTONIC, and
/// returns after the last row, on SIGTERM or on SIGINT. Tells progress on stderr and, with
/// options->json, what was sent and asked for on stdout. DIG_EIO when a bus cannot be opened.
/// Blocks SIGTERM and SIGINT in the calling thread.
DIG_MUST_CHECK enum dig_status dig_rig_serve(const struct dig_machine     *machine,
                                             const struct dig_rig_options *options,
                                             const struct dig_rig_track   *track,
                                             struct dig_error             *error);

#endif // DIG_TOOLS_RIG_COMMANDS_H
