// The window: the samples of one dig in fixed memory, and their observation along a route.
//
// In the air the window keeps the last DIG_WINDOW_BEFORE samples, as contact is detected late;
// opened, it keeps all. A full window goes on at half the rate: each new sample replaces one of
// every second stored, so that no tick moves more than one. The samples of a long dig are therefore
// out of order until dig_window_observe() sorts them.

#ifndef DIG_ESTIMATOR_TRACK_WINDOW_H
#define DIG_ESTIMATOR_TRACK_WINDOW_H

#include "core/curve.h"
#include "core/machine.h"
#include "core/observation.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#define DIG_WINDOW_MAX    16384 // samples of one dig: 80 s at 200 Hz
#define DIG_WINDOW_BEFORE 1024  // samples before contact: 5 s

/// One sample in rig scale and rig time.
struct dig_window_sample {
    double                time_s;
    struct dig_path_point pose;
    double                joint_rad[DIG_JOINTS]; // of a machine with cylinders
    bool                  has_forces;
    double                value[DIG_FORCE_CHANNELS];
    float                 sigma[DIG_FORCE_CHANNELS]; // 1 sigma
    float                 slow[DIG_FORCE_CHANNELS];  // its part that does not average down
    // What 1 sigma of each friction adds besides (core/observation.h).
    float rubs[DIG_RUBS][DIG_FORCE_CHANNELS];
};

/// Zeroed: closed and empty, stride 0 counts as 1.
struct dig_window {
    bool                     open;
    size_t                   before; // samples written into the ring since it was emptied
    struct dig_window_sample ring[DIG_WINDOW_BEFORE];
    size_t                   count;
    size_t                   stride, skipped; // every stride-th sample is kept
    size_t                   replaced;        // samples replaced since the stride doubled last
    bool                     in_progress;     // in progress: the last half_s cannot be smoothed yet
    struct dig_window_sample sample[DIG_WINDOW_MAX];
    // filled by dig_window_observe()
    double progress[DIG_WINDOW_MAX];
    double table_s[DIG_WINDOW_MAX]; // when the table's dig was there
    double value[DIG_WINDOW_MAX];   // of one channel after the other
    double smooth[DIG_WINDOW_MAX + 1];
};

/// Adds a sample. Constant time.
void dig_window_add(struct dig_window *window, const struct dig_window_sample *sample);

/// Opens the window with the samples before contact (copied: some microseconds); closes and empties
/// it.
void dig_window_open(struct dig_window *window);
void dig_window_close(struct dig_window *window);

/// Puts the samples of a long dig in the order of time; may allocate: not in the tick.
void dig_window_sort(struct dig_window *window);

/// A gap between samples longer than this, rig time, is a hole.
double dig_window_hole_s(double half_s);

/// Observes the dig along the route at the track's shift, at DIG_CURVE_POINTS of progress, each
/// where the furthest progress first reached it: a pause or a step back has no effect. Values are
/// smoothed over the path that the table's dig makes in +-half_s, as its curves are, whatever the
/// dig's own pace. A sample farther than limit_m from the route does not advance progress. sigma:
/// white noise averages over the smoothing, the slow part does not. Forces are observed where all
/// samples have them. Aborted: the dig left the route by more than half of limit_m. A dig in
/// progress is observed as far as it can be smoothed, without an ending.
///
/// DIG_ENOMATCH: fewer than two points of the grid were reached, or a gap is longer than half_s of
/// rig time, which is not interpolated. Uses the window's arrays; O(samples * corners).
/// Sorts a long dig, which may allocate: not in the tick.
DIG_MUST_CHECK enum dig_status dig_window_observe(struct dig_window      *window,
                                                  const struct dig_route *route,
                                                  const struct dig_track *track, double limit_m,
                                                  double                  half_s,
                                                  struct dig_observation *observation);

#endif // DIG_ESTIMATOR_TRACK_WINDOW_H
