// What one tick knows of the bucket, the soil and the dig going on.

#ifndef DIG_ESTIMATOR_TRACK_ESTIMATE_H
#define DIG_ESTIMATOR_TRACK_ESTIMATE_H

#include "estimator/track/motion.h"
#include "estimator/track/phase.h"
#include "estimator/wrench/soil_wrench.h"

#include <stdint.h>

/// What a tick knows. Poses are of the bucket pin in machine axes; see docs/numerics.md.
struct dig_estimate {
    int64_t           time_ns;
    struct dig_wrench wrench;
    double            pin_X_m, pin_Z_m, phi_rad; // pin and absolute direction pin -> tooth, machine
    enum dig_dig_phase phase;
    uint32_t           dig_count;  // digs finished since start
    int                trajectory; // index into the curve set of the dig going on, -1: not known
    double             progress;   // 0 … 1 along it; NaN if not known
    double             off_path_m; // distance of the real path from it, rig scale; NaN if not known
    enum dig_motion    motion;     // what it does in contact and dig
};

#endif // DIG_ESTIMATOR_TRACK_ESTIMATE_H
