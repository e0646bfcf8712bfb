// The forecast: what a match predicts along every trajectory, made by the matching thread for the
// tick.

#ifndef DIG_ESTIMATOR_PREDICT_FORECAST_H
#define DIG_ESTIMATOR_PREDICT_FORECAST_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/gravel_match.h"

#include <stdbool.h>

/// Peak and energy in machine scale, curves in rig scale.
struct dig_forecast {
    struct dig_expected {
        bool                valid;
        bool                off_table; // the table does not hold the dig in progress: not valid
        struct dig_approach approach;  // depth and attack; zeroed: the plain trajectory
        struct dig_curve    curve;     // over the progress of the tick's estimates
        double              peak_Nm, peak_sigma_Nm;
        double              energy_J, energy_sigma_J;
    } expected[DIG_TRAJECTORY_MAX];
};

/// Makes the forecast of a match for a machine lambda times the table's size. A match that is not
/// valid gives nothing valid. About four milliseconds a trajectory.
void dig_forecast_make(const struct dig_curve_set *set, double lambda,
                       const struct dig_match *match, struct dig_forecast *forecast);

struct dig_approach_error; // estimator/approach/approach_error.h

/// Forecast of a dig along a trajectory at another depth or attack, over the path of that dig, as
/// in its observation. valid = false where the table does not reach. memory: dig_approached_size()
/// of one slot; error as in dig_approached_make().
void dig_forecast_as_dug(const struct dig_curve_set *set, double lambda,
                         const struct dig_match *match, size_t trajectory,
                         const struct dig_approach       *approach,
                         const struct dig_approach_error *error, void *memory,
                         struct dig_expected *expected);

/// Converts its curve, of a dig of this depth, to the progress of the tick, which is along the
/// plain trajectory: the later legs are the same, the first begins earlier or later.
void dig_forecast_along_plain(const struct dig_curve_set *set, size_t trajectory, double depth,
                              struct dig_expected *expected);

#endif // DIG_ESTIMATOR_PREDICT_FORECAST_H
