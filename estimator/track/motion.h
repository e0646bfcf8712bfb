// What the bucket does in the soil, told from how its tooth moves, whatever the table holds:
//
//   penetration   down            drag   along, towards the cab
//   lift          up              curl   turning more than moving
//
//     tail o----------o pose     The tail is towed behind the pose on a rope through (x, z, turn),
//            rope_m   |          rig scale. Its direction is that of the last way, smoothed over
//                     v          it: the clock, a pause, noise and steps back shorter than the
//                                rope change nothing.
//
// At a way behind a corner by an angle a0 the rope still lies at a, a tractrix:
//
//   tan(a/2) = tan(a0/2) exp(-way / rope)
//
// so that a right angle is told after 0.65 to 1 rope.

#ifndef DIG_ESTIMATOR_TRACK_MOTION_H
#define DIG_ESTIMATOR_TRACK_MOTION_H

#include "estimator/track/phase.h"
#include "estimator/track/route.h"

#include <stdbool.h>

/// What the bucket does in the soil; NONE: it is not in it, or has not moved yet.
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
    enum dig_motion       motion; // of the dig going on, kept while the bucket stands
};

/// Moves the tail on to a pose in rig scale, dt_s (machine time) after the last, and tells what the
/// bucket does: NONE unless the phase is CONTACT or DIG, and before it has moved by a rope's
/// length. What fits none of them (going back, opening the bucket) leaves it as it was. In EXIT it
/// is followed, but not told: the dig may go on. In AIR it is forgotten. Constant time.
enum dig_motion dig_motion_step(struct dig_motion_state *state, double tooth_m, double dt_s,
                                enum dig_dig_phase phase, const struct dig_path_point *point);

#endif // DIG_ESTIMATOR_TRACK_MOTION_H
