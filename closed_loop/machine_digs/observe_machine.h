// The digs of a machine recording as the matcher wants them: the estimator goes through the samples
// as it does on the machine, recognises each dig, and lays it along its trajectory at rig scale.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_OBSERVE_MACHINE_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_OBSERVE_MACHINE_H

#include "core/curve.h"
#include "core/error.h"
#include "core/machine.h"
#include "core/observation.h"
#include "core/recording.h"
#include "estimator/wrench/correction.h"

#include <stddef.h>

/// Of a dig's path so much must have been measured, or it is passed over: match.least_path of a
/// daemon that is not told another.
#define DIG_OBSERVE_LEAST_PATH 0.6

/// In the order they were dug. Zeroed: none.
struct dig_observed_digs {
    size_t                  digs;
    struct dig_observation *dig;  // [digs], malloc'ed
    size_t                  seen; // those passed over among them
};

/// Every dig of the recording that followed a trajectory of the set, with the settings a daemon has
/// by default, the machine as its file says (corrected NULL) or as corrected, and lambda =
/// machine's tooth length / table's. Samples that do not tell the moment are passed over. A dig
/// that the recording breaks off is none, nor one off the table's depths. What inertia adds to the
/// forces is in their sigmas, and the depth is told (estimator/match/depth.h).
///
/// DIG_ENOMATCH: no such dig; *error says how many there were. DIG_EINVAL, DIG_EUNREACHABLE: the
/// machine fails its check. DIG_ENOMEM. Writes on success only; free with
/// dig_observed_digs_finish(). About a microsecond a sample, and for a table of several depths 1.5
/// ms an entry and dig besides.
DIG_MUST_CHECK enum dig_status dig_observe_machine(const struct dig_machine           *machine,
                                                   const struct dig_corrected_machine *corrected,
                                                   const struct dig_curve_set         *set,
                                                   const struct dig_machine_recording *recording,
                                                   struct dig_observed_digs           *digs,
                                                   struct dig_error                   *error);

/// NULL and a zeroed struct are allowed.
void dig_observed_digs_finish(struct dig_observed_digs *digs);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_OBSERVE_MACHINE_H
