// The entry that is nearest to digs by the noise-weighted distance: over every channel measured, by
// what digs scatter by and the measurement is off, with the covariance along the dig that the
// packings show. Beside the Euclidean norm of the moment (match.h), which the paper has.
//
//   q = (x - t)' D^-1 (x - t)      x, t, D as in gaussian.h
//
// with one D for all entries, that of a curve as large as the entry's that is nearest by the
// Euclidean norm, and known from as many packings: were it each entry's own, one that is known
// badly would be near to all. Trajectories are independent: their q add.

#ifndef DIG_ESTIMATOR_MATCH_WEIGHTED_H
#define DIG_ESTIMATOR_MATCH_WEIGHTED_H

#include "core/curve.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"

struct dig_weighted {
    int    entry;    // -1: nothing can be compared
    double distance; // sqrt(q / numbers compared): 1 is expected of digs of the entry's gravel
};

/// Exact, the first of several that are equal. By a summary of the set the same answer sooner; NULL
/// is allowed. nearest: the entry that D is of, which must hold all trajectories that were dug.
/// O(entries): with a summary some 0.05 microseconds each.
struct dig_weighted dig_weighted_find(const struct dig_curve_set *set,
                                      const struct dig_prefilter *prefilter,
                                      const struct dig_pool_sums *sums, size_t nearest);

#endif // DIG_ESTIMATOR_MATCH_WEIGHTED_H
