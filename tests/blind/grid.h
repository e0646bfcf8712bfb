// Moments over path progress as the blind bench's oracle compares them.

#ifndef DIG_TESTS_BLIND_GRID_H
#define DIG_TESTS_BLIND_GRID_H

#include "core/curve.h"
#include "core/recording.h"

struct blind_curve {
    double y[DIG_CURVE_POINTS];
};

/// The moment of a rig-scale dig at pace times the trajectory's speed, smoothed +-0.16 s of its own
/// time. The recording begins with the trajectory. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status blind_curve_of(const struct dig_trajectory *trajectory,
                                              double tooth_m, double pace,
                                              const struct dig_recording *recording,
                                              struct blind_curve         *curve);

/// The same of any even samples: n values, the i-th at i * step_s since the dig began.
DIG_MUST_CHECK enum dig_status blind_curve_of_samples(const struct dig_trajectory *trajectory,
                                                      double tooth_m, double pace, double step_s,
                                                      size_t n, const double value[],
                                                      struct blind_curve *curve);

/// Integral of a * b over rig time along the whole trajectory.
double blind_product(const struct dig_trajectory *trajectory, double tooth_m,
                     const struct blind_curve *a, const struct blind_curve *b);

#endif // DIG_TESTS_BLIND_GRID_H
