// Random numbers that a seed repeats, and the tails of distributions.

#ifndef DIG_CORE_CHANCE_H
#define DIG_CORE_CHANCE_H

#include <stddef.h>
#include <stdint.h>

/// Uniform in [0, 1) (splitmix64; *state moves on).
double dig_chance_uniform(uint64_t *state);

/// Uniform in [low, high).
double dig_chance_between(uint64_t *state, double low, double high);

/// Standard normal.
double dig_chance_normal(uint64_t *state);

/// One of n, n > 0.
size_t dig_chance_index(uint64_t *state, size_t n);

/// Sorts n > 0 draws and takes the ends of the interval that holds nine of ten.
void dig_chance_interval(size_t n, double drawn[], double *low, double *high);

/// P(X > x) of the gamma distribution with this mean and variance; 1 for x <= 0. Regularised
/// incomplete gamma function by series and continued fraction, relative error below 1e-10.
double dig_chance_gamma_tail(double mean, double variance, double x);

#endif // DIG_CORE_CHANCE_H
