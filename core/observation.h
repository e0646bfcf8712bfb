// An observed dig: what is matched.

#ifndef DIG_CORE_OBSERVATION_H
#define DIG_CORE_OBSERVATION_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/machine.h"

#include <stdbool.h>
#include <stdint.h>

/// How a dig ended (estimator/track/ending.h).
enum dig_ending {
    DIG_ENDING_OPEN,   // not known, or in progress
    DIG_ENDING_WHOLE,  // dug to the end of its trajectory
    DIG_ENDING_ABORTED // the bucket left its trajectory before its end
};

/// Frictions of a dig that no file tells, a number each for the whole of it: of each drive while
/// its rod moves, and then of each while it stands.
enum { DIG_RUBS = 2 * DIG_JOINTS };

/// One dig on the table's grid of progress, rig scale.
struct dig_observation {
    uint32_t            dig_count;
    int                 trajectory;
    double              off_path_m; // rms distance of path and trajectory, rig scale
    struct dig_approach made;       // depth and attack as measured; depth 0: not measured, the
                                    // table was dug at one depth and attack alone. Until
                                    // dig_depth_fit() (estimator/match/depth.h) a rough depth
    struct dig_approach approach;   // the nearest the table covers, at which the dig is matched;
                                    // zeroed: the plain trajectory. Until then that over whose path
                                    // it was observed, deeper than the table
    double first, last;             // progress range that was measured
    double moment_Nm[DIG_CURVE_POINTS]; // smoothed, rig scale; 0 outside [first, last]
    double sigma_Nm[DIG_CURVE_POINTS];  // 1 sigma of the measurement after smoothing
    bool   forces;                      // Fx and Fz were measured over the same range
    double force_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
    double force_sigma_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];

    // Of the sigmas, what 1 sigma of each friction adds to every channel, with its sign. One that
    // was saved to a file has none: there friction is a part of the noise.
    float rubs[DIG_RUBS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];

    enum dig_ending ending; // of a recording of forces: OPEN
};

#endif // DIG_CORE_OBSERVATION_H
