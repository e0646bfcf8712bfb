// What all digs of a trajectory share and no number of digs averages out: one covariance, built in
// one place. In a batch's units, where one dig scatters by 1 in every direction,
//
//   cov(mean of n digs) = (1/n + even) 1 + W (sum over parts of size size' . R + sum of shift
//   shift') W'
//
// even: the surface's and the templates' own variance, beds that repeat. A part is what a model
// may get wrong by a factor that changes smoothly along the dig: what two DEM codes make of a plain
// dig, what a template makes of an effect, what is said of another approach. size: one sigma of it,
// feature by feature; R: how alike the factor is at two bins and on two channels; W: the whitening.
// A shift is what the table may have at another place: closed_loop/fit/shifts.h.

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

/// Of a group's noise, what the approaches that were taken off its digs bring in: it is of those
/// digs alone. As long.
double dig_common_error_of_approaches(const struct dig_whitened_digs_group *group);

/// Squares of a residual of the group's mean over the covariance; residual becomes L^-1 residual.
double dig_common_error_squares(const struct dig_whitened_digs_group *group,
                                const struct dig_common_error *error, double residual[]);

/// Draws the smooth part, whitened, into y.
void dig_common_error_draw(const struct dig_whitened_digs_group *group,
                           const struct dig_common_error *error, uint64_t *seed,
                           double y[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_FIT_COMMON_ERROR_H
