// What the matching thread works out for the tick: what a match predicts along every trajectory.

#ifndef DIG_ESTIMATOR_PREDICT_FORECAST_H
#define DIG_ESTIMATOR_PREDICT_FORECAST_H

#include "core/approach.h"
#include "core/curve.h"
#include "estimator/match/gravel_match.h"

#include <stdbool.h>

/// What a match predicts along each trajectory of a table, machine scale for the whole dig's
/// numbers, rig scale for the curves.
struct dig_forecast {
    struct dig_expected {
        bool                valid;
        bool                off_table; // the dig going on is: none valid
        struct dig_approach approach;  // of the dig expected; zeroed: as the trajectory stands
        struct dig_curve    curve;     // over the progress that a tick tells
        double              peak_Nm, peak_sigma_Nm;
        double              energy_J, energy_sigma_J;
    } expected[DIG_TRAJECTORY_MAX];
};

/// What a match predicts on a machine lambda times the table's size. Nothing is valid of a match
/// that is not. About four milliseconds a trajectory.
void dig_forecast_make(const struct dig_curve_set *set, double lambda,
                       const struct dig_match *match, struct dig_forecast *forecast);

struct dig_approach_error; // estimator/approach/approach_error.h

/// What a match predicts of one dig along a trajectory, deeper or with the bucket turned; over the
/// path of the trajectory dug so, as an observation of such a dig has it. valid = false where the
/// table does not tell. Memory as dig_approached_size() of one slot; error as
/// dig_approached_make() takes it.
void dig_forecast_as_dug(const struct dig_curve_set *set, double lambda,
                         const struct dig_match *match, size_t trajectory,
                         const struct dig_approach       *approach,
                         const struct dig_approach_error *error, void *memory,
                         struct dig_expected *expected);

/// The same curve over the progress that a tick tells, which is along the plain trajectory: legs
/// behind the first lie where they lie, the first begins earlier or later.
void dig_forecast_along_plain(const struct dig_curve_set *set, size_t trajectory,
                              const struct dig_approach *approach, struct dig_expected *expected);

#endif // DIG_ESTIMATOR_PREDICT_FORECAST_H
