// Exact search for the nearest of many entries: the outlines of the curves bound the distances
// from below, and only entries that may be nearer than the best so far are compared in full. After
// the bounds of nearest-neighbour search by block means (Keogh et al. 2001, "piecewise aggregate
// approximation"); docs/numerics/match.md proves that nothing is missed.

#ifndef DIG_ESTIMATOR_MATCH_NEAREST_H
#define DIG_ESTIMATOR_MATCH_NEAREST_H

#include "estimator/match/pool.h"

/// Index of the entry nearest to the digs, the first of several equally near; -1: no entry has a
/// finite distance. O(entries): reads 64 bytes a trajectory of each, and the curves
/// whose bound is below the least distance.
int dig_nearest_find(const struct dig_curve_set *set, const struct dig_pool_sums *sums);

#endif // DIG_ESTIMATOR_MATCH_NEAREST_H
