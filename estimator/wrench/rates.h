// Rates of the joints: velocities and accelerations from angles alone, by local parabolas.
//
// Causal, for the tick: the parabola fitted to the angles of the last window_s. Its acceleration is
// that of the window's middle, its velocity is taken at its end; both are unbiased for motion of
// constant acceleration. Centred, for recordings: the parabola fitted to +-half_s around a sample,
// read off in its middle (zero phase; Savitzky & Golay 1964).
//
// Noise of the angles, white with variance sigma^2, over n samples of a window W:
//   centred  sd(velocity) = sigma sqrt(12 / n) / W     sd(acceleration) = sigma sqrt(720 / n) / W^2
//   at the end   sd(velocity) = sigma sqrt(192 / n) / W

#ifndef DIG_ESTIMATOR_WRENCH_RATES_H
#define DIG_ESTIMATOR_WRENCH_RATES_H

#include "core/machine.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_RATES_MAX   512 // angles kept by the causal filter
#define DIG_RATES_LEAST 5   // angles that tell a parabola

/// Rates of the three joints at one instant. Zeroed: standing still, known exactly.
struct dig_rates {
    double velocity_radps[DIG_JOINTS];
    double acceleration_radps2[DIG_JOINTS];
    double velocity_sigma, acceleration_sigma; // 1 sigma of any joint's
};

/// The causal filter. Zeroed it is empty; window_s > 0 must be set before the first step.
struct dig_rates_filter {
    double  window_s;
    size_t  count, head; // of the ring
    int64_t time_ns[DIG_RATES_MAX];
    double  joint_rad[DIG_RATES_MAX][DIG_JOINTS];
};

/// Takes the angles at time_ns and gives the rates. Still (with no sigma) until the window holds 5
/// angles over half its length; a gap longer than the window empties it. sigma_rad: 1 sigma of one
/// angle. O(angles in the window); when they do not fit, the window shortens.
struct dig_rates dig_rates_step(struct dig_rates_filter *filter, int64_t time_ns,
                                const double joint_rad[DIG_JOINTS], double sigma_rad);

/// Rates at sample `at` of n by the parabola through all, joint_rad[3 * i + joint]. Fewer than 5:
/// still. O(n).
struct dig_rates dig_rates_at(size_t at, size_t n, const double time_s[], const double joint_rad[],
                              double sigma_rad);

/// Rates at each of n samples of a recording, time_s ascending, joint_rad[3 * i + joint]. Where
/// fewer than 5 samples lie within +-half_s: still. O(n * samples in the window).
void dig_rates_centred(size_t n, const double time_s[], const double joint_rad[], double half_s,
                       double sigma_rad, struct dig_rates rates[]);

/// Interpolates rates and sigmas between a and b, f from 0 to 1.
struct dig_rates dig_rates_between(const struct dig_rates *a, const struct dig_rates *b, double f);

#endif // DIG_ESTIMATOR_WRENCH_RATES_H
