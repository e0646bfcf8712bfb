// The estimate of one tick: soil wrench, pose, phase and place of the dig in progress.

#ifndef DIG_ESTIMATOR_TRACK_ESTIMATE_H
#define DIG_ESTIMATOR_TRACK_ESTIMATE_H

#include "core/machine.h"
#include "estimator/track/motion.h"
#include "estimator/track/phase.h"
#include "estimator/wrench/soil_wrench.h"

#include <stdint.h>

/// Poses are of the bucket pin in machine axes; see docs/numerics.md.
struct dig_estimate {
    int64_t           time_ns;
    struct dig_wrench wrench;
    double            pin_X_m, pin_Z_m, phi_rad; // pin and absolute direction pin -> tooth, machine
    double            joint_rad[DIG_JOINTS];     // boom, arm, bucket; by a force sensor boom, arm 0
    double            pitch_rad;                 // of the machine; 0 where it does not say
    enum dig_dig_phase phase;
    uint32_t           dig_count; // digs finished since start
    int             trajectory;   // of the dig in progress, index into the curve set; -1: not known
    double          progress;     // 0 … 1 along it; NaN if not known
    double          off_path_m;   // distance from it, rig scale; NaN if not known
    enum dig_motion motion;       // of the bucket in contact and dig
};

#endif // DIG_ESTIMATOR_TRACK_ESTIMATE_H
