// The state of a daemon by its messages: the last of each kind, and the moment of the last
// seconds, measured and predicted. Messages may hold anything; numbers that are none and names that
// are none are not taken.

#ifndef DIG_TOOLS_DIGWATCH_MODEL_H
#define DIG_TOOLS_DIGWATCH_MODEL_H

#include "core/curve.h"
#include "files/lcm/health_text.h"
#include "files/lcm/lcm_message.h"
#include "files/lcm/matched_gravel.h"
#include "files/lcm/predicted_curve.h"

#include <stdbool.h>

#define DIGWATCH_TEXT    256
#define DIGWATCH_SLOTS   1024
#define DIGWATCH_SLOT_ns 125000000LL

struct digwatch_estimate {
    bool    moment_valid;
    int64_t time_ns;
    double  moment_Nm, sigma_Nm; // of noise and of the machine file's tolerances together
    int     phase, motion;
    char    trajectory[DIG_NAME_SIZE];        // "" while it is not known
    double  progress;                         // NaN while it is not known
    double  predicted_Nm, predicted_sigma_Nm; // here; NaN: no prediction
};

struct digwatch_prediction {
    bool                       valid, outside;
    int64_t                    expires_ns;
    char                       reason[DIGWATCH_TEXT]; // why there is none
    struct dig_predicted_curve curve;                 // where it is valid
};

struct digwatch_health {
    int64_t time_ns;
    int64_t count[DIG_HEALTH_COUNTERS];
    int64_t grew_ns[DIG_HEALTH_COUNTERS]; // when the counter last grew; 0: not since we listen
    int64_t frames;
    int32_t digs, matches, aborted;
    double  latency_p99_us;
    bool    realtime, memory_locked;
    char    state[DIGWATCH_TEXT], input[DIGWATCH_TEXT], note[DIGWATCH_TEXT], missing[DIGWATCH_TEXT];
};

/// The mean of one slot of time; NaN: nothing was measured, or predicted.
struct digwatch_slot {
    double measured_Nm, predicted_Nm, sigma_Nm;
};

/// The error of the prediction so far in a dig: sqrt(wrong2 / whole2).
struct digwatch_error {
    double wrong2, whole2;
};

struct digwatch_model {
    int64_t                    time_us;    // wall clock of the last message
    int64_t                    messages;   // that were understood
    int64_t                    misread;    // on our channels, and not as this build has them
    int64_t                    misread_us; // when the last of these came
    bool                       any_estimate, any_health;
    struct digwatch_estimate   estimate;
    struct dig_matched_gravel  match;
    struct digwatch_prediction prediction;
    struct digwatch_health     health;
    int64_t                    health_us;   // wall clock of that
    struct digwatch_error      now, before; // of the dig in progress and of the last one
    int64_t                    slot_index;  // of the newest slot: its time over DIGWATCH_SLOT_ns
    int                        slot_rows;   // estimates in it so far
    struct digwatch_slot       slot[DIGWATCH_SLOTS]; // number i at i % DIGWATCH_SLOTS
};

/// Nothing is known yet.
void digwatch_model_init(struct digwatch_model *model);

/// Takes a message of the daemon's channels; one that is not understood is counted. O(1), but for
/// a jump of time, which clears the slots.
void digwatch_model_take(struct digwatch_model *model, const struct dig_lcm_event *event);

/// The slot `back` before the newest; of NaN where there is none.
struct digwatch_slot digwatch_model_slot(const struct digwatch_model *model, int64_t back);

/// True when the match, or the prediction, may be used by the controller's clock, which HEALTH
/// says: estimates of a recording that is played fast have a faster one.
bool digwatch_model_match_holds(const struct digwatch_model *model);
bool digwatch_model_prediction_holds(const struct digwatch_model *model);

/// Relative error of the prediction; NaN: nothing was compared.
double digwatch_error(const struct digwatch_error *error);

#endif // DIG_TOOLS_DIGWATCH_MODEL_H
