// Error of a prediction against the digs measured along its trajectory.

#ifndef DIG_TOOLS_DIGLOOP_PREDICTION_ERROR_H
#define DIG_TOOLS_DIGLOOP_PREDICTION_ERROR_H

#include "closed_loop/accuracy/coverage.h"
#include "closed_loop/accuracy/score.h"
#include "core/error.h"
#include "estimator/match/match.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#define DIGLOOP_PREDICTION_ERROR_DIGS 64 // listed one by one

/// Zeroed: of no dig. Peaks and energies are those measured; NaN without forces.
struct digloop_prediction_error {
    struct dig_score    score;
    struct dig_coverage coverage;
    size_t              digs;
    double peak_Nm[DIGLOOP_PREDICTION_ERROR_DIGS], energy_J[DIGLOOP_PREDICTION_ERROR_DIGS];
};

/// Of all digs of --measured along trajectory t, each predicted as it was made. Fails as
/// reading and predicting do; then *errors is of the digs before.
DIG_MUST_CHECK enum dig_status
digloop_prediction_error_measure(const struct digloop_job *job, int t,
                                 const struct dig_match          *match,
                                 struct digloop_prediction_error *errors, struct dig_error *error);

/// As members of a JSON object, behind others.
void digloop_prediction_error_put(const struct digloop_prediction_error *errors);

#endif // DIG_TOOLS_DIGLOOP_PREDICTION_ERROR_H
