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

/// Its parts, where they are an array.
enum dig_part_of_wrench { DIG_PART_MY, DIG_PART_FX, DIG_PART_FZ, DIG_PARTS };

/// The wrench of its parts and their variances: of a sample, the slow part of that, and by
/// tolerances. What is not valid is 0.
struct dig_wrench dig_wrench_of_parts(const double part[DIG_PARTS],
                                      const double variance[DIG_PARTS],
                                      const double slow[DIG_PARTS],
                                      const double geometry[DIG_PARTS], bool moment_valid,
                                      bool force_valid);

#endif // DIG_ESTIMATOR_WRENCH_SOIL_WRENCH_H
