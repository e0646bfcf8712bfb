// What the tick exchanges with the matching thread through the estimator.

#include "estimator/estimator.h"

#include "estimator/approach/approach_route.h"
#include "estimator/estimator_state.h"
#include "estimator/predict/predict.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void dig_estimator_clear_dig(struct dig_estimator *const e)
{
    assert(e != NULL);
    dig_recorded_dig_clear(e->recording, e->set);
    e->next_follower = 0;
    e->choice        = (struct dig_choice){ .current = -1, .candidate = -1 };
    e->progress      = (double)NAN;
    e->off_path_m    = (double)NAN;
}

bool dig_estimator_is_idle(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return !estimator->recording->window.open;
}

size_t dig_estimator_frame(const struct dig_estimator *const e, const size_t t)
{
    assert(e != NULL && t < e->set->trajectories);
    return e->frames > 1 &&
                   e->frame[1].follower[t].track.rms_m < e->frame[0].follower[t].track.rms_m
               ? 1
               : 0;
}

bool dig_estimator_is_off_table(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    const int current = estimator->choice.current;
    bool      off     = estimator->recording->window.open && estimator->set->trajectories > 0;
    if (off && current >= 0 && estimator->forecast != NULL &&
        estimator->forecast->expected[current].off_table) {
        return true;
    }
    for (size_t t = 0; off && t < estimator->set->trajectories; t++) {
        const size_t f = dig_estimator_frame(estimator, t);

        off = estimator->frame[f].follower[t].track.rms_m > estimator->settings.path_limit_m;
    }
    return off;
}

void dig_estimator_set_table(struct dig_estimator *const       estimator,
                             const struct dig_curve_set *const set)
{
    assert(estimator != NULL && set != NULL && dig_estimator_is_idle(estimator));
    estimator->set      = set;
    estimator->forecast = NULL;
    estimator->motion   = (struct dig_motion_state){ .towed = false };
    estimator->lambda   = estimator->machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    for (size_t t = 0; t < set->trajectories; t++) {
        estimator->frame[0].route[t] = dig_approach_route(set, t);
    }
    dig_estimator_clear_dig(estimator);
}

void dig_estimator_set_machine(struct dig_estimator *const               estimator,
                               const struct dig_corrected_machine *const corrected)
{
    assert(estimator != NULL && corrected != NULL && dig_estimator_is_idle(estimator));
    struct dig_corrected_machine *const before = &estimator->corrected;
    if (corrected->corrects == before->corrects &&
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c)
        memcmp(&corrected->correction, &before->correction, sizeof before->correction) == 0) {
        return;
    }
    *before = *corrected;

    dig_phase_reset(&estimator->phase);
}

void dig_estimator_lend(struct dig_estimator *const estimator, struct dig_recorded_dig *const spare)
{
    assert(estimator != NULL && spare != NULL && estimator->spare == NULL);
    estimator->spare = spare;
}

bool dig_estimator_wants_spare(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return estimator->spare == NULL;
}

struct dig_recorded_dig *dig_estimator_take_recording(struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    struct dig_recorded_dig *const finished = estimator->finished;
    estimator->finished                     = NULL;
    return finished;
}

uint32_t dig_estimator_lost_digs(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return estimator->lost;
}

void dig_estimator_set_forecast(struct dig_estimator *const      estimator,
                                const struct dig_forecast *const forecast)
{
    assert(estimator != NULL);
    estimator->forecast = forecast;
}

// The prediction for one trajectory from `progress` to its end; valid = false without a match.
static struct dig_prediction predict_from(const struct dig_estimator *const estimator,
                                          const int trajectory, const double progress)
{
    struct dig_prediction p = { .valid = false, .trajectory = trajectory };
    if (trajectory >= 0 && (size_t)trajectory < estimator->set->trajectories &&
        estimator->forecast != NULL && estimator->forecast->expected[trajectory].valid) {
        const struct dig_expected *const along = &estimator->forecast->expected[trajectory];
        p.valid                                = true;
        p.progress_now                         = progress;
        p.from_progress                        = progress;
        p.to_progress                          = 1.0;
        p.approach                             = along->approach;
        p.peak_Nm                              = along->peak_Nm;
        p.peak_sigma_Nm                        = along->peak_sigma_Nm;
        p.energy_J                             = along->energy_J;
        p.energy_sigma_J                       = along->energy_sigma_J;
        dig_predict_points(&along->curve, estimator->lambda, &p);
    }
    return p;
}

void dig_estimator_predict(const struct dig_estimator *const estimator,
                           struct dig_prediction *const      prediction)
{
    assert(estimator != NULL && prediction != NULL);
    *prediction = predict_from(estimator, estimator->choice.current, estimator->progress);
}

void dig_estimator_predict_trajectory(const struct dig_estimator *const estimator,
                                      const int trajectory, struct dig_prediction *const prediction)
{
    assert(estimator != NULL && prediction != NULL);
    *prediction = predict_from(estimator, trajectory, 0.0);
}
