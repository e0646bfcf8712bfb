// The phase of the dig cycle, by the soil's moment alone:
//
//            > threshold, held           held again            < half threshold
//      AIR ----------------> CONTACT ----------------> DIG -----------------> EXIT
//       ^  <----------------    |                       ^  <-----------------   |
//       |   < half threshold                              > threshold           |
//       `-------------------------- gone for exit_hold_s -----------------------'
//
// The moment is low-passed over contact_hold_s, so that no single sample decides. The threshold is
// contact_sigmas times its error: the slow part of the sample's sigma, which no filter removes, and
// half the sigma for what the statics lack (seals). Half the threshold is the hysteresis.

#ifndef DIG_ESTIMATOR_TRACK_PHASE_H
#define DIG_ESTIMATOR_TRACK_PHASE_H

#include "estimator/track/settings.h"

#include <stdbool.h>

enum dig_dig_phase { DIG_PHASE_AIR, DIG_PHASE_CONTACT, DIG_PHASE_DIG, DIG_PHASE_EXIT };

enum dig_phase_event { DIG_EVENT_NONE, DIG_EVENT_CONTACT, DIG_EVENT_LOST, DIG_EVENT_FINISHED };

/// Zeroed: in the air, nothing learnt.
struct dig_phase_state {
    enum dig_dig_phase phase;
    double             filtered_Nm;
    double             bias_Nm; // of My in free air; 0 unless air_bias_s is set
    double             held_s;  // how long the condition for a change has lasted
    bool               done;    // the dig was ended by dig_phase_end(): wait for free air
};

/// Steps by one valid moment dt_s after the last. CONTACT: contact began. LOST: it did not last.
/// FINISHED: the dig is over, the bucket in the air. Constant time.
enum dig_phase_event dig_phase_step(struct dig_phase_state              *state,
                                    const struct dig_estimator_settings *settings, double dt_s,
                                    double moment_Nm, double sigma_Nm, double slow_sigma_Nm);

/// Ends a dig by its path, whatever load the bucket still carries: the phase is EXIT until the
/// moment is gone, and cannot fall back to DIG.
void dig_phase_end(struct dig_phase_state *state);

/// Resets filter and bias, as the moment changes its meaning with the machine; the phase stays.
void dig_phase_reset(struct dig_phase_state *state);

#endif // DIG_ESTIMATOR_TRACK_PHASE_H
