// The rows of free air of one joint under noise that lasts: how likely they are, effects integrated
// out.

#ifndef DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H
#define DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H

#include "closed_loop/machine/machine_lines.h"

/// Rows are means over blocks of readings that are means over a kernel: noise of a variance of 1 in
/// the mean of a block, and in two neighbours' product over how alike the noise is a block apart.
struct dig_noise_mean {
    double alone, shared;
    double apart; // how alike noise is a block apart
};

/// Of noise that is e times less alike after lasts_s, in blocks of so many points.
struct dig_noise_mean dig_noise_mean_of(double lasts_s, size_t points);

/// The rows of one joint, in their order, and what they are told by.
struct dig_joint_rows {
    size_t  rows, columns;
    size_t *row;
    double *rest;    // N
    double *slope;   // [columns][rows], N
    double *white;   // both with noise taken off: [1 + columns][rows]
    double *h;       // [columns * columns]
    double  white_N; // rms of the rows' sigmas
};

/// Which air is asked.
enum dig_air_part { DIG_AIR_ALL, DIG_AIR_BEFORE, DIG_AIR_AFTER };

/// Takes the joint's rows and the columns that change them from the lines as last updated. rest:
/// what is left of the rows, [rows of the air], in their sigmas. Finish it. DIG_ENOMEM leaves
/// nothing to finish.
DIG_MUST_CHECK enum dig_status dig_joint_rows_make(const struct dig_lines *lines,
                                                   const double rest[], enum dig_joint which,
                                                   enum dig_air_part      part,
                                                   struct dig_joint_rows *of);

void dig_joint_rows_finish(struct dig_joint_rows *of);

/// -2 log likelihood with noise of that size, effects integrated out, mean NULL: without. Leaves
/// what they leave of the white rests there. O(rows columns^2).
double dig_joint_rows_misfit(const struct dig_air *air, struct dig_joint_rows *of,
                             const struct dig_noise_mean *mean, double size2_N2);

#endif // DIG_CLOSED_LOOP_MACHINE_JOINT_ROWS_H
