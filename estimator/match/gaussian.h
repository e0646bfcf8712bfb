// How likely digs along one trajectory are of a gravel, by the covariance along the dig and between
// channels that the table's packings show (core/curve.h, struct dig_covariance).
//
// Compared are means over the blocks of the path: x of d digs, t of the table's curve at the
// gravel, the mean of n packings. With the size a of each channel's curve there, S the covariance
// and C_ij = S_ij / sqrt(S_ii S_jj),
//
//   q = (x - t)' D^-1 (x - t),   D_ij = u_i u_j C_ij,   u_i^2 = a^2 S_ii (1/d + 1/n) + sigma_i^2 /
//   d
//
// and the digs are less likely by q / 2 + log det D / 2. What the measurement is off by goes
// together with nothing: off the diagonal C is less by its share, of digs as large as those
// measured. C is drawn a little towards what depends on the distance of two blocks alone, and gets
// a share of each number's own.

#ifndef DIG_ESTIMATOR_MATCH_GAUSSIAN_H
#define DIG_ESTIMATOR_MATCH_GAUSSIAN_H

#include "core/curve.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"

/// Degrees of freedom from which on a table's own covariance is believed: some for each number.
#define DIG_GAUSSIAN_FREEDOM (4.0 * DIG_COVARIANCE_NUMBERS)

/// Of the digs along one trajectory; does not depend on the gravel. 6 kB.
struct dig_gaussian {
    const struct dig_prefilter *prefilter; // NULL: none
    size_t                      trajectory, channels;
    size_t                      numbers; // compared; 0: it tells nothing
    struct dig_compared {
        size_t channel, block;
        bool   first, second;        // half of the block that was measured whole
        double mean, sigma2;         // of the digs, sigma2 of their mean
        double inverse_digs, spread; // sqrt(S_ii)
    } compared[DIG_COVARIANCE_NUMBERS];
    // L of C = L L', below the diagonal; on it the inverse.
    double lower[DIG_COVARIANCE_NUMBERS][DIG_COVARIANCE_NUMBERS];
};

/// False, and nothing to be asked, when the set has no covariance of that trajectory, or one of
/// fewer degrees of freedom than DIG_GAUSSIAN_FREEDOM, or no half of a block was measured whole.
/// The set, and the summary of it where one is given, must outlive it. 30 microseconds.
bool dig_gaussian_make(const struct dig_curve_set *set, const struct dig_prefilter *prefilter,
                       const struct dig_pooled *group, struct dig_gaussian *gaussian);

/// The same whatever is known of the set: where it holds no covariance to be believed, the one of
/// entry_scatter.h with the table's pooled spread. False when nothing was measured.
bool dig_gaussian_make_default(const struct dig_curve_set *set,
                               const struct dig_prefilter *prefilter,
                               const struct dig_pooled *group, struct dig_gaussian *gaussian);

/// What digs are off a cell of the trajectory.
struct dig_mahalanobis {
    double square;  // q
    double log_det; // of D, but for a constant
};

/// In about a microsecond.
struct dig_mahalanobis dig_gaussian_mahalanobis(const struct dig_gaussian *gaussian,
                                                const struct dig_cell     *cell);

/// The u_i of a cell.
void dig_gaussian_scale(const struct dig_gaussian *gaussian, const struct dig_cell *cell,
                        double u[DIG_COVARIANCE_NUMBERS]);

#endif // DIG_ESTIMATOR_MATCH_GAUSSIAN_H
