// The recording of the dig in progress, made from the tick's estimates. Another thread keeps its
// own copy, so that it can observe the dig before it is over without asking the tick.

#ifndef DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H
#define DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H

#include "core/observation.h"
#include "estimator/track/estimate.h"
#include "estimator/track/recorded_dig.h"
#include "estimator/track/settings.h"
#include "estimator/wrench/correction.h"

struct dig_live_recording {
    bool                    digging;   // a dig is in progress
    uint32_t                dig_count; // digs finished before it
    struct dig_recorded_dig recording;
};

/// Drops the recording; the rest of a dig in progress is not recorded. Required before the first
/// estimate and when the table changes.
void dig_live_recording_clear(struct dig_live_recording *live, const struct dig_curve_set *set);

/// Adds the estimate of one tick of a machine lambda times the table's size. Estimates come in
/// order; one that is left out counts as a missing sample. Constant time.
void dig_live_recording_add(struct dig_live_recording *live, const struct dig_curve_set *set,
                            double lambda, const struct dig_estimate *estimate);

/// Observes the dig so far, as dig_recorded_dig_observe() does a finished one, the machine's
/// inertia taken off (estimator/track/inertia.h; NULL: none), its friction stated or not. The
/// observation ends half a smoothing window before the newest sample. dig_count is the one the dig
/// will get. DIG_ENOMATCH also when no dig is in progress. Copies the recording (3 MB at most) into
/// scratch and works there: two to three milliseconds.
DIG_MUST_CHECK enum dig_status
dig_live_recording_observe(const struct dig_curve_set          *set,
                           const struct dig_estimator_settings *settings,
                           const struct dig_machine *machine, const struct dig_friction stated[],
                           const struct dig_live_recording *live, struct dig_recorded_dig *scratch,
                           struct dig_observation *observation);

#endif // DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H
