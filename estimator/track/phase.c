#include "estimator/track/phase.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Error of the statics (seals), in sigmas of one sample.
static const double unmodelled_share = 0.5;

// Times a condition; true once it has held for long enough.
static bool held(double *const held_s, const bool condition, const double dt_s,
                 const double needed_s)
{
    *held_s = condition ? *held_s + dt_s : 0.0;
    return condition && *held_s >= needed_s;
}

static void enter(struct dig_phase_state *const state, const enum dig_dig_phase phase)
{
    state->phase  = phase;
    state->held_s = 0.0;
}

// In free air the moment is the bias.
static void learn_bias(struct dig_phase_state *const              state,
                       const struct dig_estimator_settings *const settings, const double dt_s,
                       const double limit_Nm)
{
    if (settings->air_bias_s > 0.0 && fabs(state->filtered_Nm) < limit_Nm) {
        state->bias_Nm += state->filtered_Nm * dt_s / (settings->air_bias_s + dt_s);
    }
}

enum dig_phase_event dig_phase_step(struct dig_phase_state *const              state,
                                    const struct dig_estimator_settings *const settings,
                                    const double dt_s, const double moment_Nm,
                                    const double sigma_Nm, const double slow_sigma_Nm)
{
    assert(state != NULL && settings != NULL);

    const double share = dt_s / (settings->contact_hold_s + dt_s);
    state->filtered_Nm += (moment_Nm - state->bias_Nm - state->filtered_Nm) * share;

    const double threshold_Nm =
        settings->contact_sigmas * hypot(slow_sigma_Nm, unmodelled_share * sigma_Nm);
    const bool high = state->filtered_Nm > threshold_Nm;
    const bool low  = state->filtered_Nm < 0.5 * threshold_Nm;

    switch (state->phase) {
    case DIG_PHASE_AIR:
        learn_bias(state, settings, dt_s, 0.5 * threshold_Nm);
        if (held(&state->held_s, high, dt_s, settings->contact_hold_s)) {
            enter(state, DIG_PHASE_CONTACT);
            return DIG_EVENT_CONTACT;
        }
        break;
    case DIG_PHASE_CONTACT:
        if (low) {
            enter(state, DIG_PHASE_AIR);
            return DIG_EVENT_LOST;
        }
        if (held(&state->held_s, high, dt_s, settings->contact_hold_s)) {
            enter(state, DIG_PHASE_DIG);
        }
        break;
    case DIG_PHASE_DIG:
        if (low) {
            enter(state, DIG_PHASE_EXIT);
        }
        break;
    case DIG_PHASE_EXIT:
        if (high && !state->done) {
            enter(state, DIG_PHASE_DIG);
        } else if (held(&state->held_s, low, dt_s, settings->exit_hold_s)) {
            enter(state, DIG_PHASE_AIR);
            const bool was_done = state->done;
            state->done         = false;
            return was_done ? DIG_EVENT_NONE : DIG_EVENT_FINISHED;
        }
        break;
    default: break;
    }
    return DIG_EVENT_NONE;
}

void dig_phase_end(struct dig_phase_state *const state)
{
    assert(state != NULL);
    enter(state, DIG_PHASE_EXIT);
    state->done = true;
}

void dig_phase_reset(struct dig_phase_state *const state)
{
    assert(state != NULL);
    state->filtered_Nm = 0.0;
    state->bias_Nm     = 0.0;
    state->held_s      = 0.0;
}
