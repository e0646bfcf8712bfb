// The whole run of the machine as it truly is, before any sensor: what digrig records and serves.

#ifndef DIG_TOOLS_RIG_MOTION_TRACK_H
#define DIG_TOOLS_RIG_MOTION_TRACK_H

#include "core/error.h"
#include "core/machine.h"
#include "core/recording.h"
#include "tools/rig/motion/gauge.h"
#include "tools/rig/motion/path.h"
#include "tools/rig/motion/placement.h"
#include "tools/rig/motion/state.h"

#include <stdbool.h>
#include <stddef.h>

struct dig_rig_row {
    struct dig_rig_pose      pose;   // machine frame
    struct dig_rig_wrench    soil;   // machine frame
    struct dig_rig_joints    joints; // of a machine with cylinders, and so are the pressures
    struct dig_rig_pressures pressures;
    struct dig_rig_load      load; // of one with a force sensor
};

/// Row i is at i * step_s. Owned by the caller; free with dig_rig_track_finish().
struct dig_rig_track {
    size_t                   rows;
    double                   step_s;
    struct dig_rig_row      *row;
    struct dig_rig_placement placement;
    struct dig_rig_margin    nearest; // the limit that came nearest over all rows
    double                   blend_off_m, blend_off_rad;
};

struct dig_rig_track_options {
    double scene_tooth_m; // of the recordings' bucket, pin to tooth
    double rate_Hz;       // of the rows; a divisor of 1000
    bool   air;
    double air_pace; // tools/rig/motion/path.h
    bool   blend;
    bool   quasi_static; // the inertia of the links is left out
    bool   placed;       // at pin_X_m, pin_Z_m; else where the machine has most room
    double pin_X_m, pin_Z_m;
};

struct dig_rig_track_options dig_rig_track_options_default(void);

/// Path, placement, joints, pressures. Refuses what the machine cannot do, naming what stops it,
/// its peak and its limit: DIG_EUNREACHABLE for a pose or a joint, stroke or lever out of bounds,
/// DIG_EINVAL for a dig beyond a relief pressure or a force sensor's range, or that lifts or tips
/// the machine; DIG_ENOMEM. A bucket on a force sensor can be carried anywhere: its pin starts at
/// 0, 0. Accelerations are central differences of the links' places over +-5 ms. A few seconds for
/// minutes of machine time.
DIG_MUST_CHECK enum dig_status
dig_rig_track_build(const struct dig_machine *machine, const struct dig_rig_track_options *options,
                    size_t recordings, const struct dig_recording recording[],
                    struct dig_rig_track *track, struct dig_error *error);

/// The same of a motion in free air (tools/rig/motion/air.h): of the options rate_Hz counts.
DIG_MUST_CHECK enum dig_status dig_rig_track_build_air(const struct dig_machine           *machine,
                                                       const struct dig_rig_track_options *options,
                                                       struct dig_rig_track               *track,
                                                       struct dig_error                   *error);

/// NULL and a zeroed struct are allowed.
void dig_rig_track_finish(struct dig_rig_track *track);

#endif // DIG_TOOLS_RIG_MOTION_TRACK_H
