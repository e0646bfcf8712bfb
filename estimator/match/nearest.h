// The nearest of very many entries, exactly, without a look at each curve: the outlines of a
// summary bound the distances from below, and only what may be nearer than the best so far is
// compared in full. After the bounds of nearest-neighbour search by block means (Keogh et al. 2001,
// "piecewise aggregate approximation"); docs/numerics/estimator.md shows that nothing is missed.

#ifndef DIG_ESTIMATOR_MATCH_NEAREST_H
#define DIG_ESTIMATOR_MATCH_NEAREST_H

#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"

/// Index of the entry that dig_match_nearest() finds by looking at all, the first of several
/// that are equally near; -1: no entry has a finite distance. O(entries): 64 bytes a trajectory of
/// each, and all of those curves that the outlines cannot tell from the nearest.
int dig_nearest_find(const struct dig_prefilter *prefilter, const struct dig_pool_sums *sums);

#endif // DIG_ESTIMATOR_MATCH_NEAREST_H
