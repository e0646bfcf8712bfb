// How one dig scatters about the mean of its gravel, as a table's own packings show it.
//
// Relative to the size of the dig (dig_features_amplitude()), all entries of a trajectory share one
// covariance of features, times a factor that depends on the gravel's strength:
//
//   cov(one dig) = factor(strength) amplitude^2 S,   strength = log(amplitude of My / density)
//
// S is pooled over all packings of all entries and shrunk towards correlations that depend on the
// distance along the dig alone. It is widened by what left-out digs exceed it by, and has a floor
// of DIG_SCATTER_FLOOR of the amplitude: no DEM knows the curves better than that.
//
// Beds of one gravel differ most in the directions in which gravels differ. These are other ones at
// each gravel, so S, which is pooled, is too small in them. What left-out digs exceed S by in these
// directions is measured, and added to S there.

#ifndef DIG_CLOSED_LOOP_MODEL_SCATTER_H
#define DIG_CLOSED_LOOP_MODEL_SCATTER_H

#include "closed_loop/model/response_surface.h"
#include "core/error.h"

#define DIG_SCATTER_FLOOR 0.002

struct dig_scatter {
    // Degrees of freedom that S, or at least its size, is known from; 0: S is as the table states
    // it.
    double freedom[DIG_TRAJECTORY_MAX];
    double covariance[DIG_TRAJECTORY_MAX][DIG_FEATURES][DIG_FEATURES]; // S
    double widened[DIG_TRAJECTORY_MAX]; // variance of digs that took no part, over S
    // The same in the directions of other gravels, beyond that; and L of the S that it is beyond.
    double as_gravels[DIG_TRAJECTORY_MAX];
    double lower[DIG_TRAJECTORY_MAX][DIG_FEATURES][DIG_FEATURES];
    double strength[DIG_TRAJECTORY_MAX]; // at which the factor is 1
    double slope[DIG_TRAJECTORY_MAX];    // of the factor over strength
    // What S was pooled from, as large as digs at factor 1 that took no part in S.
    size_t residuals[DIG_TRAJECTORY_MAX];
    double (*residual[DIG_TRAJECTORY_MAX])[DIG_FEATURES];
};

/// Measures it from the runs of the table at path, whose surface is given. A trajectory whose
/// entries hold too few second packings gets its S from the curves' standard deviations and the
/// correlation of neighbours that suits these packings best. Free with dig_scatter_destroy().
DIG_MUST_CHECK enum dig_status dig_scatter_measure(const char                        *path,
                                                   const struct dig_response_surface *surface,
                                                   struct dig_scatter               **scatter,
                                                   struct dig_error                  *error);

/// The same from residuals at hand: what dig_scatter_measure() does after reading. Takes ownership
/// of nothing. residual[i] is of a dig along trajectory[i] at strength[i], relative to amplitude,
/// of an entry with packings[i] digs.
struct dig_scatter_residual {
    size_t trajectory, entry, packings;
    double strength;
    double place[DIG_AXES]; // of the entry's gravel
    double value[DIG_FEATURES];
};
DIG_MUST_CHECK enum dig_status dig_scatter_pool(const struct dig_response_surface *surface,
                                                size_t                             residuals,
                                                const struct dig_scatter_residual  residual[],
                                                struct dig_scatter               **scatter);

/// NULL is allowed.
void dig_scatter_destroy(struct dig_scatter *scatter);

/// The factor at a strength, held within 0.4 … 2.5.
double dig_scatter_factor(const struct dig_scatter *scatter, size_t trajectory, double strength);

/// What digs of a gravel differ by as gravels do, beyond S: 1 sigma of it in each of as many
/// directions, relative to amplitude. of: what each axis changes of the gravel's dig, by any step,
/// relative to amplitude; the sigmas take its place.
void dig_scatter_as_gravels(const struct dig_scatter *scatter, size_t trajectory,
                            double of[DIG_AXES][DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_MODEL_SCATTER_H
