#include "estimator/predict/forecast.h"

#include "estimator/approach/approached.h"
#include "estimator/approach/laid.h"
#include "estimator/match/match.h"
#include "estimator/predict/peak_energy.h"
#include "estimator/predict/predict.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

// Curve and whole dig along one trajectory of the set.
static void expect(const struct dig_curve_set *const set, const double lambda,
                   const struct dig_match *const match, const size_t trajectory,
                   struct dig_expected *const expected)
{
    struct dig_peak_energy whole;
    expected->off_table = false;
    expected->valid     = dig_predict_curve(set, match, trajectory, &expected->curve) == DIG_OK &&
                      dig_peak_energy_predict(set, match, trajectory, &whole) == DIG_OK;
    if (expected->valid) {
        const double lambda4     = pow(lambda, 4.0);
        expected->peak_Nm        = lambda4 * whole.peak_Nm;
        expected->peak_sigma_Nm  = lambda4 * whole.peak_sigma_Nm;
        expected->energy_J       = lambda4 * whole.energy_J;
        expected->energy_sigma_J = lambda4 * whole.energy_sigma_J;
    }
}

void dig_forecast_make(const struct dig_curve_set *const set, const double lambda,
                       const struct dig_match *const match, struct dig_forecast *const forecast)
{
    assert(set != NULL && match != NULL && forecast != NULL);
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        forecast->expected[t].off_table = false;
        forecast->expected[t].valid     = false;
        forecast->expected[t].approach  = dig_approach_plain();
        if (t < set->trajectories) {
            expect(set, lambda, match, t, &forecast->expected[t]);
        }
    }
}

void dig_forecast_as_dug(const struct dig_curve_set *const set, const double lambda,
                         const struct dig_match *const match, const size_t trajectory,
                         const struct dig_approach *const       approach,
                         const struct dig_approach_error *const error, void *const memory,
                         struct dig_expected *const expected)
{
    assert(set != NULL && match != NULL && approach != NULL && expected != NULL);
    const struct dig_approached_slot  slot = { trajectory, *approach, 0.0, NULL };
    const struct dig_curve_set *const dug  = dig_approached_make(set, 1, &slot, error, memory);
    expected->approach                     = *approach;
    expect(dug, lambda, match, 0, expected);
}

static void read_at(const double place[const DIG_CURVE_POINTS], float curve[const DIG_CURVE_POINTS])
{
    float out[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        out[k] = (float)dig_curve_at(curve, place[k]);
    }
    memcpy(curve, out, sizeof out);
}

void dig_forecast_along_plain(const struct dig_curve_set *const set, const size_t trajectory,
                              const double depth, struct dig_expected *const expected)
{
    assert(expected != NULL);
    double place[DIG_CURVE_POINTS];
    dig_laid_places(set, trajectory, 1.0, depth, place);
    for (int c = 0; c < DIG_CHANNELS; c++) {
        read_at(place, expected->curve.mean[c]);
        read_at(place, expected->curve.sd[c]);
    }
}
