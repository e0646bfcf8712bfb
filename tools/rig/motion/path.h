// The path of the bucket through air and soil at machine scale, before it is placed.
//
//   hover - open - curl - approach | dig (the recording) | lift - dump - curl - lower | next, or
//   home
//   `------- air, soil = 0 -------'  `- soil as recorded -'  ^ load held  `- fades with the dump,
//                                                                            then air, soil = 0
//
// The rig's recording is scaled by Froude similarity: lambda = machine tooth length / scene tooth
// length; lengths times lambda, times sqrt(lambda), forces lambda^3, moments lambda^4. The rig's +x
// is the machine's -X, its z the machine's Z, phi = -pi/2 - theta; FX = -Fx, FZ = Fz, and the rig's
// My is the machine's counter-clockwise moment as it stands. Poses are relative to the pin of the
// first recording's first row; the placement adds where that is.

#ifndef DIG_TOOLS_RIG_MOTION_PATH_H
#define DIG_TOOLS_RIG_MOTION_PATH_H

#include "core/error.h"
#include "core/recording.h"
#include "tools/rig/motion/work.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_RIG_STEP_s  1e-3 // of the path
#define DIG_RIG_BLEND_s 0.2  // whole width of the blend of velocity jumps

struct dig_rig_frame {
    struct dig_rig_pose   pose; // from the first dig's first pin position
    struct dig_rig_wrench soil;
};

/// Frame i is at i * DIG_RIG_STEP_s. Owned by the caller; free with dig_rig_path_finish().
struct dig_rig_path {
    size_t                frames;
    struct dig_rig_frame *frame;
    double                air_pace;        // as it was asked for
    double                contact_phi_rad; // bucket attitude at the first dig's first row
    double                blend_off_m;     // farthest the blend moved the pin …
    double                blend_off_rad;   // … and turned the bucket
};

struct dig_rig_path_options {
    double lambda;   // > 0
    double tooth_m;  // the machine's bucket, pin to tooth
    bool   air;      // false: the dig alone; one recording only
    bool   blend;    // false: velocity jumps stay, and so do the accelerations they cause
    double air_pace; // > 0 with air: 1 is at most 0.7 m/s2, and accelerations grow as its square
};

/// At least 2 s of air at the pace of 1 lie before each contact and after each dump. Velocity jumps
/// are blended by a symmetric smoothing (three moving averages of a third of DIG_RIG_BLEND_s each),
/// which leaves straight, even motion untouched and cuts a corner of dv m/s by less than
/// DIG_RIG_BLEND_s / 12 * dv. Forces are not smoothed. DIG_EINVAL for a lambda that is not
/// positive, no recording, or more than one without air; DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_rig_path_build(const struct dig_rig_path_options *options,
                                                  size_t                             recordings,
                                                  const struct dig_recording         recording[],
                                                  struct dig_rig_path               *path,
                                                  struct dig_error                  *error);

/// NULL and a zeroed struct are allowed.
void dig_rig_path_finish(struct dig_rig_path *path);

#endif // DIG_TOOLS_RIG_MOTION_PATH_H
