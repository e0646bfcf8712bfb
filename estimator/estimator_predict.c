// The estimator's last stage: from the forecast given to predictions of digs.

#include "estimator/estimator.h"
#include "estimator/estimator_state.h"
#include "estimator/predict/predict.h"

#include <assert.h>
#include <stddef.h>

void dig_estimator_set_forecast(struct dig_estimator *const      estimator,
                                const struct dig_forecast *const forecast)
{
    assert(estimator != NULL);
    estimator->forecast = forecast;
}

void dig_estimator_give_match(struct dig_estimator *const   estimator,
                              const struct dig_match *const match)
{
    assert(estimator != NULL && match != NULL);
    dig_forecast_make(estimator->set, estimator->lambda, match, &estimator->own_forecast);
    estimator->forecast = &estimator->own_forecast;
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
