// Intervals of a hypothesis' numbers from its posterior, with a uniform prior within the bounds of
// the table and the effects. Numbers at a bound, and those that trade off against each other, need
// no case of their own.

#ifndef DIG_CLOSED_LOOP_FIT_POSTERIOR_H
#define DIG_CLOSED_LOOP_FIT_POSTERIOR_H

#include "closed_loop/fit/hypothesis.h"

#include <stdint.h>

/// Fills fitted->low and high: the shortest interval that holds 90 % of each number's posterior,
/// the fitted one in it. By a cloud of points that begins everywhere and follows powers of the
/// likelihood up to the posterior (sequential Monte Carlo: Del Moral, Doucet & Jasra 2006), by the
/// covariance at the fit: a single walk stays in one arm of a bent ridge. Templates are off by a
/// share of what the effects add; a point that adds more or less makes it another, less likely one.
/// Writes the covariance of z of the batch's steps, [steps * steps], with what the numbers leave
/// open, where covariance is not NULL. Some hundredths of a second.
void dig_posterior_intervals(const struct dig_batch *batch, uint64_t seed,
                             struct dig_fitted *fitted, double covariance[]);

#endif // DIG_CLOSED_LOOP_FIT_POSTERIOR_H
