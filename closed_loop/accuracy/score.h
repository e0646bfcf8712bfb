// Error of a predicted dig: the relative Euclidean norm that every report quotes.
//
//   error = sqrt( sum over digs of integral (measured - predicted)^2 dt
//               / sum over digs of integral measured^2 dt )
//
// over rig time on a 200 Hz grid, from contact to exit, of moments smoothed with +-0.16 s.

#ifndef DIG_CLOSED_LOOP_ACCURACY_SCORE_H
#define DIG_CLOSED_LOOP_ACCURACY_SCORE_H

#include "core/curve.h"

/// Running sums; a zeroed struct is an empty score.
struct dig_score {
    double wrong_N2m2s; // integral (measured - predicted)^2
    double
        floor_N2m2s; // integral sigma^2: what wrong would be on average if the model were complete
    double whole_N2m2s; // integral measured^2
};

/// Adds one dig along trajectory. measured, predicted and sigma (1 sigma of one dig about the
/// prediction) stand on DIG_CURVE_POINTS of path progress, rig scale; only the progress range
/// [first, last], from contact to exit, counts. O(duration * 200 Hz).
void dig_score_add(struct dig_score *score, const struct dig_trajectory *trajectory, double tooth_m,
                   double first, double last, const double measured_Nm[DIG_CURVE_POINTS],
                   const double predicted_Nm[DIG_CURVE_POINTS],
                   const double sigma_Nm[DIG_CURVE_POINTS]);

/// Rig time that a point of the progress grid stands for: half the way to either neighbour.
double dig_score_time_s(const struct dig_curve_set *set, size_t trajectory, size_t point);

/// The error defined above; NaN when nothing was added.
double dig_score_error(const struct dig_score *score);

/// 1 sigma of what the error would be if the model were complete; NaN when nothing was added.
double dig_score_noise_floor(const struct dig_score *score);

#endif // DIG_CLOSED_LOOP_ACCURACY_SCORE_H
