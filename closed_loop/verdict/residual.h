// What is left of one dig: measured minus predicted, by part of the dig and channel, over rig time.

#ifndef DIG_CLOSED_LOOP_VERDICT_RESIDUAL_H
#define DIG_CLOSED_LOOP_VERDICT_RESIDUAL_H

#include "closed_loop/recordings/measured.h"
#include "closed_loop/verdict/trace.h"
#include "core/curve.h"

#include <stdbool.h>

/// Of one channel in one part of a dig; all NaN where nothing was measured. relative adds up in
/// squares over the parts: of the moment the sum's root is CONTRACT's error of this dig.
struct dig_residual {
    double rms; // N m or N
    double
        relative;  // sqrt(integral of its square over the part / of the measured one's, whole dig)
    double sigmas; // rms of it over 1 sigma of one dig about the prediction, sensors included
};

/// By the curves before or after, of enum dig_part DIG_PART_SOIL and DIG_PART_LIFTED; that of the
/// air is all NaN.
void dig_residual_of(const struct dig_curve_set *set, const struct dig_measured *dig,
                     const struct dig_trace_curves *curves, bool after,
                     struct dig_residual residual[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS]);

#endif // DIG_CLOSED_LOOP_VERDICT_RESIDUAL_H
