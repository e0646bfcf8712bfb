// Covariance of the mean of a trajectory's digs, with the errors that all digs share and no number
// of digs averages out. In a batch's units, where one dig scatters by 1 in every direction,
//
//   cov(mean of n digs) = (1/n + even) 1 + W (sum over parts of size size' . R + sum of shift
//   shift') W'
//
// even: the surface's and the templates' own variance, beds that repeat. A part is what a model
// may get wrong by a factor that changes smoothly along the dig: the difference of two DEM codes,
// the form of a template, another approach. size: 1 sigma of it, feature by feature; R: correlation
// of the factor between bins and channels; W: the whitening. Shifts: closed_loop/fit/shifts.h.

#ifndef DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H
#define DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H

#include "closed_loop/fit/shifts.h"

#include <stdint.h>

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
void dig_common_error_build(const struct dig_whitened_digs_group *group,
                            struct dig_common_error              *error);

/// The part of a group's noise that comes from its digs' other approaches, which were subtracted.
/// It is of those digs alone. Some microseconds.
double dig_common_error_of_approaches(const struct dig_whitened_digs_group *group);

/// Squares of a residual of the group's mean over the covariance; residual becomes L^-1 residual.
double dig_common_error_squares(const struct dig_whitened_digs_group *group,
                                const struct dig_common_error *error, double residual[]);

/// Draws the smooth part, whitened, into y.
void dig_common_error_draw(const struct dig_whitened_digs_group *group,
                           const struct dig_common_error *error, uint64_t *seed,
                           double y[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H
