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
    double count[DIG_CURVE_POINTS];      // digs that measured the point
    double mean_Nm[DIG_CURVE_POINTS];    // of them; 0 where there is none
    double sigma2_Nm2[DIG_CURVE_POINTS]; // mean square of their sigmas
    // Means of the forces, Fx and Fz, and mean squares of their sigmas; only when every dig has
    // them.
    bool   forces;
    double force_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
    double force_sigma2_N2[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
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
/// About 6 kB a trajectory are written. O(digs).
void dig_pool_sum(size_t digs, const struct dig_observation dig[], struct dig_pool_sums *sums);

#endif // DIG_ESTIMATOR_MATCH_POOL_H
