// How wrong curves interpolated over depth and attack may be, told by leaving out what was dug.
//
// Along an axis, every dig between two others is told from these; what it is off beyond the scatter
// of the means is curvature, and the error of a straight line between two digs h apart is at most
// that of leaving one out: e = |bend| (x - low) (high - x). An axis with a dig on one side alone
// tells nothing of its curvature: there all of the change is taken for bent. Between gravels, every
// dig of one is told from the others' change; what that is off beyond the scatter is added where a
// gravel borrows.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_ERROR_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_ERROR_H

#include "core/approach.h"
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
