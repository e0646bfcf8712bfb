// Covariance of the mean of a trajectory's digs, with the errors that all digs share and no number
// of digs averages out. In a batch's units, where one dig scatters by 1 in every direction,
//
//   cov(mean of n digs) = (1/n + even) 1 + W (sum over parts of size size' . R + sum of shift
//   shift') W'
//
// even: the surface's and the templates' own variance, beds that repeat. A part is what a model
// may get wrong by a factor that changes smoothly along the dig: the difference of two DEM codes,
// the form of a template, another approach. size: 1 sigma of it, feature by feature; R: correlation
// of the factor between bins and channels; W: the whitening. A shift: the table
// may have a dig at a neighbouring gravel's place, or an effect at another gravel's or magnitude;
// 1 sigma each.

#ifndef DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H
#define DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H

#include "closed_loop/fit/forward.h"

#include <stdint.h>

/// One for each axis of the gravel, one for each axis of the effects together, and one for each
/// effect's magnitude.
#define DIG_SHIFTS_MAX (2 * DIG_AXES + DIG_HYPOTHESIS_EFFECTS)

struct dig_shifts {
    size_t shifts;
    double of[DIG_SHIFTS_MAX][DIG_FEATURES]; // units of the table
    // 1 sigma, beyond S, of the beds' mean and of the surface in the direction of each axis.
    double as_gravels[DIG_AXES][DIG_FEATURES];
};

/// True where some effect has templates, which may be off.
bool dig_shifts_templated(const struct dig_hypothesis *hypothesis);

/// The shifts of a group's mean dig, each of a trajectory's own. plain: at number; added: what the
/// effects add there.
void dig_shifts_fill(const struct dig_batch *batch, size_t group,
                     const struct dig_hypothesis *hypothesis, const double number[],
                     const struct dig_plain *plain, const double added[DIG_FEATURES],
                     struct dig_shifts *shifts);

/// 1 sigma, beside an effect of the soil, of the error that all trajectories share: of the gravel's
/// place and of the effects' u. A fit takes it for another gravel, so no residual shows it.
void dig_shifts_common(const struct dig_batch *batch, const struct dig_hypothesis *hypothesis,
                       const double number[], double sigma[DIG_HYPOTHESIS_NUMBERS]);

#define DIG_COMMON_ERROR_PARTS 4 // all but the third change slowly along the dig

struct dig_common_error {
    double            even;
    double            size[DIG_COMMON_ERROR_PARTS][DIG_FEATURES]; // 1 sigma, units of the table
    struct dig_shifts shift;
    double            inverse[DIG_FEATURES * DIG_FEATURES]; // L^-1 of the group's covariance L L'
    double            log_det;
    double            noise; // variance beyond 1/n, mean over the features
};

/// Fills inverse, log_det and noise from even, size and shift. Some microseconds.
void dig_common_error_build(const struct dig_group *group, struct dig_common_error *error);

/// The part of a group's noise that comes from its digs' other approaches, which were subtracted.
/// It is of those digs alone. Some microseconds.
double dig_common_error_of_approaches(const struct dig_group *group);

/// Squares of a residual of the group's mean over the covariance; residual becomes L^-1 residual.
double dig_common_error_squares(const struct dig_group *group, const struct dig_common_error *error,
                                double residual[]);

/// Draws the smooth part, whitened, into y.
void dig_common_error_draw(const struct dig_group *group, const struct dig_common_error *error,
                           uint64_t *seed, double y[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H
