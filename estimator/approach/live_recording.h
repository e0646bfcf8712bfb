// A dig going on, followed from what each tick tells: another thread's own copy of what the
// estimator records, so that it can look at the dig before it is over without asking the tick for
// anything.

#ifndef DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H
#define DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H

#include "estimator/track/estimate.h"
#include "estimator/track/observation.h"
#include "estimator/track/recorded_dig.h"
#include "estimator/track/settings.h"

struct dig_live_recording {
    bool                    on;   // a dig goes on
    uint32_t                digs; // finished before it
    struct dig_recorded_dig raw;
};

/// Forgets all; a dig that goes on is not seen any more. Before the first estimate, and when the
/// table becomes another.
void dig_live_recording_forget(struct dig_live_recording *shadow, const struct dig_curve_set *set);

/// What a tick of a machine lambda times the table's size told; each of them, in order. Some that
/// are missing are samples that are missing. Constant time.
void dig_live_recording_take(struct dig_live_recording *shadow, const struct dig_curve_set *set,
                             double lambda, const struct dig_estimate *estimate);

/// What was dug so far, as dig_recorded_dig_observe() has it, up to where samples on both sides
/// smooth it: last is less than 1 until the path is done. dig_count is that of the dig when it will
/// be finished. DIG_ENOMATCH when no dig goes on, too. Copies what was recorded into scratch, 2.5
/// MB at most, and works there: two to three milliseconds.
DIG_MUST_CHECK enum dig_status
dig_live_recording_observe(const struct dig_curve_set          *set,
                           const struct dig_estimator_settings *settings,
                           const struct dig_live_recording     *shadow,
                           struct dig_recorded_dig *scratch, struct dig_observation *observation);

#endif // DIG_ESTIMATOR_APPROACH_LIVE_RECORDING_H
