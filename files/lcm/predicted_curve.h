// A PREDICTION as a curve that is read anywhere along it. A message may hold anything: it is
// checked once, here.

#ifndef DIG_FILES_LCM_PREDICTED_CURVE_H
#define DIG_FILES_LCM_PREDICTED_CURVE_H

#include "core/curve.h"

#include "messages/digsight_prediction_t.h"

#include <stdbool.h>

#define DIG_PREDICTED_POINTS 64

/// No machine has as much: a message that says more is somebody else's.
#define DIG_MOMENT_MOST_Nm 1e9

/// Machine scale.
struct dig_predicted_curve {
    char   trajectory[DIG_NAME_SIZE];
    double from, to;                        // trajectory progress, which the points divide equally
    double moment_Nm[DIG_PREDICTED_POINTS]; // finite, as are sigma_Nm
    double sigma_Nm[DIG_PREDICTED_POINTS];
    double peak_Nm, peak_sigma_Nm; // of the whole dig; any number
    double energy_J, energy_sigma_J;
};

/// False, and nothing is written, where the message is not valid, has another number of points, no
/// trajectory's name, no range within 0 … 1, or a moment that is none.
bool dig_predicted_curve_take(const digsight_prediction_t *message,
                              struct dig_predicted_curve  *curve);

/// Linear between the points. False, and nothing is written, outside of them and at NaN.
bool dig_predicted_curve_at(const struct dig_predicted_curve *curve, double progress,
                            double *moment_Nm, double *sigma_Nm);

#endif // DIG_FILES_LCM_PREDICTED_CURVE_H
