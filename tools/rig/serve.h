// digrig serve: the run of the machine on real buses, in time.

#ifndef DIG_TOOLS_RIG_SERVE_H
#define DIG_TOOLS_RIG_SERVE_H

#include "core/error.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/options.h"

/// Opens every bus asked for, plays the track against absolute deadlines of CLOCK_MONOTONIC, and
/// returns after the last row, on SIGTERM or on SIGINT. Tells progress on stderr and, with
/// options->json, what was sent and asked for on stdout. DIG_EIO when a bus cannot be opened.
/// Blocks SIGTERM and SIGINT in the calling thread.
DIG_MUST_CHECK enum dig_status dig_rig_serve(const struct dig_machine     *machine,
                                             const struct dig_rig_options *options,
                                             const struct dig_rig_track   *track,
                                             struct dig_error             *error);

#endif // DIG_TOOLS_RIG_SERVE_H
