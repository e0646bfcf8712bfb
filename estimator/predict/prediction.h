// The predicted resistance of a dig.

#ifndef DIG_ESTIMATOR_PREDICT_PREDICTION_H
#define DIG_ESTIMATOR_PREDICT_PREDICTION_H

#include "core/approach.h"

#include <stdbool.h>

#define DIG_PREDICTION_POINTS 64

/// Along one trajectory, machine scale, rig axes.
struct dig_prediction {
    bool                valid;
    int                 trajectory;
    struct dig_approach approach; // depth and attack; zeroed: the plain trajectory
    double              progress_now;
    double from_progress, to_progress; // the points below are equally spaced over this range
    double moment_Nm[DIG_PREDICTION_POINTS];
    double sigma_Nm[DIG_PREDICTION_POINTS]; // 1 sigma of one dig about the prediction
    double Fx_N[DIG_PREDICTION_POINTS], Fz_N[DIG_PREDICTION_POINTS];
    double sigma_Fx_N[DIG_PREDICTION_POINTS], sigma_Fz_N[DIG_PREDICTION_POINTS];
    double peak_Nm, peak_sigma_Nm;   // of the whole dig: expectation and 1 sigma of one
    double energy_J, energy_sigma_J; // dig about it (estimator/predict/peak_energy.h)
};

#endif // DIG_ESTIMATOR_PREDICT_PREDICTION_H
