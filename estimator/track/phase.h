// Where in its cycle the bucket is, told from the soil's moment alone:
//
//            > threshold, held           held again            < half threshold
//      AIR ----------------> CONTACT ----------------> DIG -----------------> EXIT
//       ^  <----------------    |                       ^  <-----------------   |
//       |   < half threshold                              > threshold           |
//       `-------------------------- gone for exit_hold_s -----------------------'
//
// What is compared is the moment low-passed over contact_hold_s, so single samples decide nothing.
// The threshold is contact_sigmas times what that may be wrong by: the slow part of the sample's
// sigma, which no filter takes away, and half the sigma for what the statics lack (inertia, seals).
// The half threshold below is the hysteresis.

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
    double             held_s;  // how long what would change the phase has lasted
    bool               done;    // the dig was ended from outside: wait for free air
};

/// Moves the state on by one valid moment dt_s after the last. TOUCHED: contact began (a window is
/// to be opened). LOST: the contact did not last. GONE: the dig is over, the bucket is in the air.
/// Constant time.
enum dig_phase_event dig_phase_step(struct dig_phase_state              *state,
                                    const struct dig_estimator_settings *settings, double dt_s,
                                    double moment_Nm, double sigma_Nm, double slow_sigma_Nm);

/// Ends a dig from outside (its path is over, whatever the bucket still carries): the phase is EXIT
/// until the moment has gone, and cannot fall back to DIG.
void dig_phase_end(struct dig_phase_state *state);

/// Forgets what was learnt of the moment, as it is another one from now on; the phase stays.
void dig_phase_reset(struct dig_phase_state *state);

#endif // DIG_ESTIMATOR_TRACK_PHASE_H
