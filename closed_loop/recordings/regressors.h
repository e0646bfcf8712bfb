// State of a dig at each point of its path, from its trajectory: regressors of its residual. Rig
// scale.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_REGRESSORS_H
#define DIG_CLOSED_LOOP_RECORDINGS_REGRESSORS_H

#include "closed_loop/recordings/measured.h"
#include "core/curve.h"

#include <stdbool.h>
#include <stddef.h>

enum dig_regressors {
    DIG_REGRESSOR_PATH,          // progress, 0 … 1
    DIG_STATE_DEPTH_m,           // of the tooth below the ground, where the dig begins
    DIG_STATE_SPEED_mps,         // of the tooth
    DIG_STATE_ACCELERATION_mps2, // of the tooth, amount
    DIG_STATE_FILL_m2,  // what the tooth has swept below the ground so far, seen from aside
    DIG_REGRESSOR_PASS, // how often the place was dug, counted from 1
    DIG_REGRESSORS
};

/// "path", "depth_m", "speed_mps", "acceleration_mps2", "fill_m2", "pass".
const char *dig_regressors_name(enum dig_regressors state);

/// All states at the points of the progress grid. Speed and acceleration are differences of the
/// tooth's places +-DIG_SMOOTH_HALF_s apart, times the dig's pace and its square; at the ends the
/// nearest that lie within the dig.
void dig_regressors_along(const struct dig_curve_set *set, const struct dig_measured *dig,
                          double state[DIG_REGRESSORS][DIG_CURVE_POINTS]);

/// True where a dig is lifted out: the last phase, when it goes up.
bool dig_regressors_is_lifted(const struct dig_curve_set *set, size_t trajectory, double progress);

#endif // DIG_CLOSED_LOOP_RECORDINGS_REGRESSORS_H
