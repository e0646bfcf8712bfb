// The pool: digs of one ground, matched together. The scatter of single digs averages down in their
// mean; the error of the table's means, common to all, does not.

#ifndef DIG_ESTIMATOR_MATCH_POOL_H
#define DIG_ESTIMATOR_MATCH_POOL_H

#include "core/curve.h"
#include "core/observation.h"

#define DIG_POOL_MAX 8

/// The last DIG_POOL_MAX digs, oldest first. Zeroed: none.
struct dig_pool {
    size_t                 digs;
    struct dig_observation dig[DIG_POOL_MAX];
};

/// Appends a dig; from a full pool the oldest leaves.
void dig_pool_add(struct dig_pool *pool, const struct dig_observation *dig);

/// Sums of the digs along one trajectory, point by point.
struct dig_pooled {
    size_t trajectory;
    double count[DIG_CURVE_POINTS]; // digs that measured the point
    bool   forces;                  // every dig has them; else only the moment is summed
    // Of each channel the mean of them, 0 where there is none, and the mean square of their sigmas,
    // friction of the drives left out.
    double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double sigma2[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    // What 1 sigma of each drive's friction adds to the mean: all digs of a machine share it.
    bool   rubbed; // anywhere
    float  rubs[DIG_RUBS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double scatter_Nm2; // squares of moment less mean, over digs and points
    double norm2_Nm2;   // squares of the moments, over digs and points
};

/// The sums along each trajectory that was dug.
struct dig_pool_sums {
    size_t            digs;
    uint32_t          dig_count; // of the youngest
    size_t            groups;
    struct dig_pooled group[DIG_TRAJECTORY_MAX];
};

/// Sums of digs that each passed dig_observations_check(), youngest last; any number from 1 on.
/// About 33 kB a trajectory are written. O(digs).
void dig_pool_sum(size_t digs, const struct dig_observation dig[], struct dig_pool_sums *sums);

#endif // DIG_ESTIMATOR_MATCH_POOL_H
