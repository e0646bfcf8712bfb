// Friction of the drives that no file tells: what it may have added to digs of one machine.
//
// With what a drive's friction of 1 sigma adds to all numbers as a column of V, and D the
// covariance of all else, the digs' is D + V V'. By Woodbury's identity and its like for the
// determinant (Hager 1989), with A = V' D^-1 V and b = V' D^-1 x,
//
//   x' (D + V V')^-1 x = x' D^-1 x - b' (1 + A)^-1 b,   det(D + V V') = det D det(1 + A)

#ifndef DIG_ESTIMATOR_MATCH_RUBBED_H
#define DIG_ESTIMATOR_MATCH_RUBBED_H

#include "core/observation.h"

#include <stddef.h>

/// b, and A at and below its diagonal. Zeroed: nothing.
struct dig_rubbed {
    double b[DIG_RUBS], a[DIG_RUBS][DIG_RUBS];
};

/// Adds what one number does: x and its row of V, whitened by D.
void dig_rubbed_add(double x, const double v[DIG_RUBS], struct dig_rubbed *rubbed);

void dig_rubbed_join(struct dig_rubbed *sum, const struct dig_rubbed *more);

/// b' (1 + A)^-1 b and log det(1 + A).
struct dig_rubbed_sums {
    double explained, log_det;
};

/// Where every number counts so often.
struct dig_rubbed_sums dig_rubbed_sum(const struct dig_rubbed *rubbed, double weight);

/// What is left of x' x without what friction explains, where noise makes all numbers together
/// floor2: floor2 x' D^-1 x with D = floor2 + V V'. What was added was not whitened.
double dig_rubbed_left2(const struct dig_rubbed *rubbed, double x2, double floor2);

#endif // DIG_ESTIMATOR_MATCH_RUBBED_H
