// Interpolation error over depth and attack, measured by leaving out what was dug.
//
// Along an axis, every dig between two others is interpolated from these. Its error beyond the
// scatter of the means is curvature; the error of a straight line between two digs is then at most
// e = |bend| (x - low) (high - x). With a dig on one side alone the curvature is not known, and all
// of the change counts as curvature. Between gravels, every dig of one is predicted by the others'
// change; its error beyond the scatter is added where a gravel borrows.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_ERROR_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_ERROR_H

#include "core/curve.h"

/// Of one trajectory; all relative to the rms of the plain curve.
struct dig_approach_error {
    double bend_depth[DIG_CHANNELS];  // per factor^2
    double bend_attack[DIG_CHANNELS]; // per rad^2
    double borrowed[DIG_CHANNELS];    // at the farthest approach dug
    double farthest_m;
};

/// Over all gravels, root mean square. O(entries * digs).
void dig_approach_error_measure(const struct dig_curve_set *set, size_t trajectory,
                                struct dig_approach_error *error);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_ERROR_H
