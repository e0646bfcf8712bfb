// The digs of a trajectory that tell of scatter, each about the mean of its gravel's, and the
// covariance that they have in common.

#ifndef DIG_CLOSED_LOOP_MODEL_PACKINGS_H
#define DIG_CLOSED_LOOP_MODEL_PACKINGS_H

#include "closed_loop/model/scatter.h"

#define DIG_PACKINGS_FOLDS 10

struct dig_packing {
    const struct dig_scatter_residual *of;
    double                             freedom; // its share of a degree: 1 - 1 / packings
    double                             factor;  // of its strength
    size_t                             fold;    // below DIG_PACKINGS_FOLDS
};

/// Those of the residuals that are along a trajectory and of an entry with two packings or more,
/// with the factor 1; how many. packing has room for all.
size_t dig_packings_take(size_t trajectory, size_t residuals,
                         const struct dig_scatter_residual residual[],
                         struct dig_packing                packing[]);

/// S of the packings, each over its factor, without those of one fold (DIG_PACKINGS_FOLDS: of all),
/// drawn towards even correlations and without its floor; how many degrees of freedom it is pooled
/// from.
double dig_packings_pool(size_t packings, const struct dig_packing packing[], size_t without,
                         double s[DIG_FEATURES][DIG_FEATURES]);

/// Adds the floor to S.
void dig_packings_add_floor(double s[DIG_FEATURES][DIG_FEATURES]);

/// The variance of a packing over that of one dig, averaged over the directions S = L L' knows.
double dig_packing_size(const double              lower[DIG_FEATURES][DIG_FEATURES],
                        const struct dig_packing *packing);

#endif // DIG_CLOSED_LOOP_MODEL_PACKINGS_H
