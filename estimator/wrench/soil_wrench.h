// The wrench of the soil on the bucket at one instant.

#ifndef DIG_ESTIMATOR_WRENCH_SOIL_WRENCH_H
#define DIG_ESTIMATOR_WRENCH_SOIL_WRENCH_H

#include <stdbool.h>

struct dig_wrench {
    // Soil on bucket, in the RIG's axes (x towards the cab, z up, y such that My > 0 resists curl)
    // but at the machine's scale: N and Nm.
    double Fx_N, Fz_N, My_Nm;
    double sigma_Fx_N, sigma_Fz_N, sigma_My_Nm; // 1 sigma, from quantisation, sensor noise
    bool   force_valid, moment_valid;
    // The part of sigma_My that does not average down over many samples (quantisation of a signal
    // that stands still); included in sigma_My_Nm.
    double slow_sigma_My_Nm;
    double slow_sigma_Fx_N, slow_sigma_Fz_N; // the same of the forces
    // 1 sigma from the machine's tolerances, apart from the above and not in it: one error for the
    // whole run, which the digs of one machine share. Of the whole: the root of the sum of squares.
    double geometry_sigma_Fx_N, geometry_sigma_Fz_N, geometry_sigma_My_Nm;
};

#endif // DIG_ESTIMATOR_WRENCH_SOIL_WRENCH_H
