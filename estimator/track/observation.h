// A finished dig as it is matched.

#ifndef DIG_ESTIMATOR_TRACK_OBSERVATION_H
#define DIG_ESTIMATOR_TRACK_OBSERVATION_H

#include "core/approach.h"
#include "core/curve.h"

#include <stdbool.h>
#include <stdint.h>

/// How a dig ended, as far as it can be told (estimator/track/ending.h).
enum dig_ending {
    DIG_ENDING_OPEN,   // not told, or it goes on
    DIG_ENDING_WHOLE,  // dug to the end of its trajectory
    DIG_ENDING_ABORTED // the bucket left its trajectory before
};

/// A finished dig on the table's grid, in rig units: what is matched.
struct dig_observation {
    uint32_t            dig_count;
    int                 trajectory;
    double              off_path_m; // rms distance of path and trajectory, rig scale
    struct dig_approach made;       // how it was dug, as the dig itself tells; depth 0: not told,
                                    // the table was dug in one way alone
    struct dig_approach approach;   // the nearest to that the table knows, which it is laid along
                                    // and matched at; zeroed: the trajectory as it stands
    double first, last;             // progress range that was measured
    double moment_Nm[DIG_CURVE_POINTS]; // smoothed, rig scale; 0 outside [first, last]
    double sigma_Nm[DIG_CURVE_POINTS];  // 1 sigma of the measurement after smoothing
    bool   forces;                      // Fx and Fz were measured, too, as far as the moment
    double force_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
    double force_sigma_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];

    enum dig_ending ending; // of a recording of forces: not told
};

#endif // DIG_ESTIMATOR_TRACK_OBSERVATION_H
