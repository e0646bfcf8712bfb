// Error of a predicted dig, the relative Euclidean norm that every report quotes, and the share of
// its points that lies within the band of the prediction.
//
//   error = sqrt( sum over digs of integral (measured - predicted)^2 dt
//               / sum over digs of integral measured^2 dt )
//
// over rig time on a 200 Hz grid, from contact to exit, of moments smoothed with +-0.16 s.

#ifndef DIG_CLOSED_LOOP_ACCURACY_SCORE_H
#define DIG_CLOSED_LOOP_ACCURACY_SCORE_H

#include "core/curve.h"
#include "core/observation.h"

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

/// Standard deviations to either side of 90 % of normal errors.
#define DIG_COVERAGE_SIGMAS 1.645

/// Over digs; zeroed: none. Forces only of digs that have them.
struct dig_coverage {
    size_t points[DIG_FORCE_CHANNELS];
    size_t inside[DIG_FORCE_CHANNELS];
};

/// Adds the points that were measured of one dig, equally spaced over its path. curve: what was
/// predicted, with 1 sigma of one dig; the measurement's own sigma is added in quadrature.
void dig_coverage_add(struct dig_coverage *coverage, const struct dig_observation *dig,
                      const struct dig_curve *curve);

/// Share of the points within the band; NaN when the channel was not measured.
double dig_coverage_share(const struct dig_coverage *coverage, enum dig_channel channel);

#endif // DIG_CLOSED_LOOP_ACCURACY_SCORE_H
