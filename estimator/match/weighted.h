// The entry nearest to digs by the noise-weighted (Mahalanobis) distance over every channel
// measured, with the covariance of the packings along the dig. The paper's Euclidean norm of the
// moment is in match.h.
//
//   q = (x - t)' D^-1 (x - t)      x, t, D as in gaussian.h
//
// with one D for all entries, that of the entry nearest by the Euclidean norm: with its own D each,
// an entry of large variance would be near to every dig. Trajectories are independent: their q add.

#ifndef DIG_ESTIMATOR_MATCH_WEIGHTED_H
#define DIG_ESTIMATOR_MATCH_WEIGHTED_H

#include "core/curve.h"
#include "estimator/match/pool.h"

struct dig_weighted {
    int    entry;    // -1: nothing can be compared
    double distance; // sqrt(q / numbers compared): 1 is expected of digs of the entry's gravel
};

/// Exact, the first of several that are equal. nearest: the entry of D, which must have all
/// trajectories that were dug. O(entries): some 0.05 microseconds each.
struct dig_weighted dig_weighted_find(const struct dig_curve_set *set,
                                      const struct dig_pool_sums *sums, size_t nearest);

#endif // DIG_ESTIMATOR_MATCH_WEIGHTED_H
