// The motion of the bucket in the soil, by how its tooth moves, whatever the table holds:
//
//   penetration   down            drag   along, towards the cab
//   lift          up              curl   turning more than moving
//
//     tail o----------o pose     A tail is towed behind the pose on a rope through (x, z, turn),
//     rig
//            rope_m   |          scale. The rope's direction is that of the path, smoothed over its
//                     v          length: the clock, a pause, noise and steps back shorter than the
//                                rope have no effect.
//
// At path length s behind a corner of angle a0 the rope's angle is a (a tractrix):
//
//   tan(a/2) = tan(a0/2) exp(-s / rope)
//
// so that a right angle is detected after 0.65 to 1 rope.

#ifndef DIG_ESTIMATOR_TRACK_MOTION_H
#define DIG_ESTIMATOR_TRACK_MOTION_H

#include "estimator/track/phase.h"
#include "estimator/track/route.h"

#include <stdbool.h>

/// NONE: not in the soil, or not moved yet.
enum dig_motion {
    DIG_MOTION_NONE,
    DIG_MOTION_PENETRATION,
    DIG_MOTION_DRAG,
    DIG_MOTION_CURL,
    DIG_MOTION_LIFT
};

/// Zeroed: nothing known.
struct dig_motion_state {
    bool                  towed; // the tail was laid
    struct dig_path_point point; // low-passed over some samples
    struct dig_path_point tail;
    enum dig_motion       motion; // of the dig in progress, kept while the bucket rests
};

/// Moves the tail on to a pose in rig scale, dt_s (machine time) after the last, and returns the
/// motion: NONE unless the phase is CONTACT or DIG, and until the pose has moved by a rope's
/// length. A movement that fits none (going back, opening the bucket) leaves the last motion. In
/// EXIT the state is kept, as the dig may go on; in AIR it is cleared. Constant time.
enum dig_motion dig_motion_step(struct dig_motion_state *state, double tooth_m, double dt_s,
                                enum dig_dig_phase phase, const struct dig_path_point *point);

#endif // DIG_ESTIMATOR_TRACK_MOTION_H
