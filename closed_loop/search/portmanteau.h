// Tests whether the residual of digs is white along them, by Ljung and Box's statistic of each
// dig's whitened bins, channel by channel,
//
//   Q = sum over channels of n (n + 2) sum over lags l of r_l^2 / (n - l)
//   r_l = sum z_k z_(k+l) / sum z_k^2
//
// without subtracting the mean: a residual of one sign is not white, one in a single bin is. Its
// distribution when nothing is missing comes from digs drawn from the fitted hypothesis and fitted
// again (closed_loop/search/null_simulation.h), as whitened bins of a table's residuals are not
// quite normal or independent.

#ifndef DIG_CLOSED_LOOP_SEARCH_PORTMANTEAU_H
#define DIG_CLOSED_LOOP_SEARCH_PORTMANTEAU_H

#include "closed_loop/fit/hypothesis.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_PORTMANTEAU_LAGS 3

struct dig_whiteness {
    size_t digs;
    double statistic; // mean over digs of Q
    double low, high; // its 90 % interval, digs drawn anew; both the value with one dig
    double expected;  // mean of it over digs that lack nothing
    double p;         // chance of one as large
};

/// Q of one channel: n numbers, at most n - 1 lags; 0 for fewer than two.
double dig_portmanteau(size_t n, const double z[]);

/// Of a batch by a fitted hypothesis, against draws draws from it.
struct dig_whiteness dig_portmanteau_judge(const struct dig_whitened_digs *batch,
                                           const struct dig_fitted *fitted, size_t draws,
                                           uint64_t seed);

#endif // DIG_CLOSED_LOOP_SEARCH_PORTMANTEAU_H
