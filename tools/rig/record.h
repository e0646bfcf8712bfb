// digrig record: the run of the machine as a machine recording.

#ifndef DIG_TOOLS_RIG_RECORD_H
#define DIG_TOOLS_RIG_RECORD_H

#include "core/error.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/options.h"

/// What the sensors read along the track, written to options->out; and the truth, if asked for.
/// DIG_EIO, DIG_ENOMEM; then no file of ours is left half written.
DIG_MUST_CHECK enum dig_status dig_rig_record(const struct dig_machine     *machine,
                                              const struct dig_rig_options *options,
                                              const struct dig_rig_track   *track,
                                              struct dig_error             *error);

#endif // DIG_TOOLS_RIG_RECORD_H
