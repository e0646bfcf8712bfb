// Gaussian likelihood of digs along one trajectory given a gravel, by the covariance of the table's
// packings along the dig and between channels (core/curve.h, struct dig_covariance).
//
// It compares means over blocks of the path: x of d digs, t of the table's curve at the gravel, the
// mean of n packings. With the size a of each channel's curve there, S the covariance and
// C_ij = S_ij / sqrt(S_ii S_jj),
//
//   q = (x - t)' D^-1 (x - t),   D_ij = u_i u_j C_ij,
//   u_i^2 = a^2 (S_ii (1/d + 1/n) + e^2) + sigma_i^2 / d
//
// and -log L = q / 2 + log det D / 2. e is what the table's curve errs by beyond its packings'
// scatter (struct dig_curve). Measurement errors are uncorrelated: off the diagonal C shrinks by
// their share, for digs as large as those measured. C is shrunk towards its mean over blocks
// equally far apart, the more the fewer packings it is from, and gets a share of independent
// variance on the diagonal. Of too few packings S is that of entry_scatter.h, with the table's
// pooled spread.
//
// Parts that are common to all digs, of the table, do not average down with their number; nor does
// friction of a machine's drives (rubbed.h), which is added to D.

#ifndef DIG_ESTIMATOR_MATCH_GAUSSIAN_H
#define DIG_ESTIMATOR_MATCH_GAUSSIAN_H

#include "core/curve.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/pool.h"

#include <stdbool.h>

/// Weight of the logarithm of this likelihood: the covariance and the curves between the table's
/// points are less certain than it assumes.
#define DIG_GAUSSIAN_TRUST 0.7

/// Of the digs along one trajectory; does not depend on the gravel. 6 kB.
struct dig_gaussian {
    const struct dig_curve_set *set;
    size_t                      trajectory, channels;
    size_t                      numbers; // compared
    struct dig_compared {
        size_t channel, block;
        bool   first, second;        // half of the block that was measured completely
        double mean, sigma2;         // of the digs, sigma2 of their mean
        double rubs[DIG_RUBS];       // what 1 sigma of each drive's friction adds to the mean
        double inverse_digs, spread; // sqrt(S_ii)
    } compared[DIG_COVARIANCE_NUMBERS];
    bool rubbed; // by drives whose friction is not known
    // L of C = L L', below the diagonal; on it the inverse.
    double lower[DIG_COVARIANCE_NUMBERS][DIG_COVARIANCE_NUMBERS];
};

/// Compares nothing (numbers is 0) when no half of a block was measured completely. The set
/// must outlive it. 30 microseconds.
void dig_gaussian_make(const struct dig_curve_set *set, const struct dig_pooled *group,
                       struct dig_gaussian *gaussian);

/// Squared Mahalanobis distance of digs from a cell of the trajectory.
struct dig_mahalanobis {
    double square;  // q
    double log_det; // of D, up to a constant
};

/// Of a cell of the set. About a microsecond.
struct dig_mahalanobis dig_gaussian_mahalanobis(const struct dig_gaussian *gaussian,
                                                const struct dig_cell     *cell);

/// log L at a cell, tempered by DIG_GAUSSIAN_TRUST, up to a constant. The same cost.
double dig_gaussian_log(const struct dig_gaussian *gaussian, const struct dig_cell *cell);

/// The u_i of a cell.
void dig_gaussian_scale(const struct dig_gaussian *gaussian, const struct dig_cell *cell,
                        double u[DIG_COVARIANCE_NUMBERS]);

#endif // DIG_ESTIMATOR_MATCH_GAUSSIAN_H
