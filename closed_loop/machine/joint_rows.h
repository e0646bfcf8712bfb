// Likelihood of one joint's rows of free air under correlated noise, with effects integrated out.

#ifndef DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H
#define DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H

#include "closed_loop/machine/machine_lines.h"

/// Rows are means over blocks of readings that are means over a kernel. Of noise of variance 1:
/// variance of a block's mean, and covariance of two neighbours over the correlation a block apart.
struct dig_noise_mean {
    double alone, shared;
    double apart; // correlation of the noise a block apart
};

/// Of noise with the correlation time lasts_s, in blocks of so many points.
struct dig_noise_mean dig_noise_mean_of(double lasts_s, size_t points);

/// The rows of one joint, in their order, and the columns that change them.
struct dig_joint_rows {
    size_t  rows, columns;
    size_t *row;
    double *rest;    // N
    double *slope;   // [columns][rows], N
    double *white;   // both whitened: [1 + columns][rows]
    double *h;       // [columns * columns]
    double  white_N; // rms of the rows' sigmas
};

/// Which air counts.
enum dig_air_part { DIG_AIR_ALL, DIG_AIR_BEFORE, DIG_AIR_AFTER };

/// Takes the joint's rows and the columns that change them from the lines as last updated. rest:
/// the rows' residuals, [rows of the air], in their sigmas. Free with dig_joint_rows_finish();
/// DIG_ENOMEM leaves nothing to free.
DIG_MUST_CHECK enum dig_status dig_joint_rows_make(const struct dig_lines *lines,
                                                   const double rest[], enum dig_joint which,
                                                   enum dig_air_part      part,
                                                   struct dig_joint_rows *of);

void dig_joint_rows_finish(struct dig_joint_rows *of);

/// -2 log likelihood with noise of variance size2_N2, effects integrated out; mean NULL: without
/// noise. Leaves the residuals after effects in the first row of white. O(rows columns^2).
double dig_joint_rows_misfit(const struct dig_air *air, struct dig_joint_rows *of,
                             const struct dig_noise_mean *mean, double size2_N2);

#endif // DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H
