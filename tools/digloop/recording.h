// Recordings as files: of which kind one is, those of a machine whatever wrote them, and the digs
// that a file of any kind holds.

#ifndef DIG_TOOLS_DIGLOOP_RECORDING_H
#define DIG_TOOLS_DIGLOOP_RECORDING_H

#include "closed_loop/machine_digs/observe_machine.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/machine.h"
#include "core/recording.h"
#include "tools/digloop/commands.h"

#include <stdbool.h>

/// False for a machine recording and an LCM log; true for all else: reading it as a force recording
/// says what is wrong with it.
bool digloop_is_force_recording(const char *path);

/// The machine of --machine, and what the model of --model says of it.
struct digloop_machine {
    struct dig_machine           machine;
    double                       lambda; // its bucket's length over that of the table's
    struct dig_corrected_machine corrected;
};

/// A machine recording of whatever wrote it, for what goes by the machine's forces. Refuses
/// readings of another kind than the machine has, and pressures that were cut off: what is missing
/// there would be taken for the soil's.
DIG_MUST_CHECK enum dig_status digloop_read_machine(const char                   *path,
                                                    const struct dig_machine     *machine,
                                                    struct dig_machine_recording *recording,
                                                    struct dig_error             *error);

/// Reads --machine, where given, into *machine and takes --model, where given, into it and into the
/// curves of the job's set. Refuses a bucket whose shape is not that of the table's scene, and what
/// dig_load_model() does.
DIG_MUST_CHECK enum dig_status digloop_load_machine(const struct digloop_job *job,
                                                    struct digloop_machine   *machine,
                                                    struct dig_error         *error);

/// The index of --trajectory in the set. DIG_EINVAL names it when there is none.
DIG_MUST_CHECK enum dig_status digloop_find_trajectory(const struct digloop_job *job,
                                                       int *trajectory, struct dig_error *error);

/// The digs of a file: one of a force recording, all that followed a trajectory of a machine's.
/// trajectory: only those along it, or -1. DIG_ENOMATCH names the file when there is none;
/// DIG_EINVAL for a machine's recording without a machine (NULL). Free with
/// dig_observed_digs_finish().
DIG_MUST_CHECK enum dig_status digloop_read_digs(const struct digloop_job *job, const char *path,
                                                 int trajectory, struct dig_observed_digs *digs,
                                                 struct dig_error *error);

#endif // DIG_TOOLS_DIGLOOP_RECORDING_H
