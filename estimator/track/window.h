// The samples of one dig, kept in a fixed place, and the observation made of them in its end.
//
// In the air the window only remembers the last DIG_WINDOW_BEFORE samples, as contact is noticed
// late; opened, it keeps everything. A full window goes on at half the rate, and every sample that
// comes then takes the place of one of every second that is there: no tick moves more than one. So
// samples of a long dig do not lie in the order of time until dig_window_observe() sorts them.

#ifndef DIG_ESTIMATOR_TRACK_WINDOW_H
#define DIG_ESTIMATOR_TRACK_WINDOW_H

#include "core/curve.h"
#include "estimator/track/observation.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

#define DIG_WINDOW_MAX 16384 // samples of one dig that are kept

#define DIG_WINDOW_BEFORE 1024

/// One sample in rig scale and rig time.
struct dig_window_sample {
    double                time_s;
    double                moment_Nm;
    struct dig_path_point pose;
    float                 sigma_Nm, slow_Nm;
    bool                  has_forces;
    float                 force_N[DIG_FORCE_CHANNELS - 1]; // Fx, Fz
    float                 force_sigma_N[DIG_FORCE_CHANNELS - 1];
    float                 force_slow_N[DIG_FORCE_CHANNELS - 1];
};

/// Zeroed: closed and empty, stride 0 counts as 1.
struct dig_window {
    bool                     open;
    size_t                   before; // samples written into the ring since it was emptied
    struct dig_window_sample ring[DIG_WINDOW_BEFORE];
    size_t                   count;
    size_t                   stride, skipped; // every stride-th sample is kept
    size_t                   replaced;        // samples replaced since the stride doubled last
    bool                     goes_on; // more will come: the last half_s cannot be smoothed yet
    struct dig_window_sample sample[DIG_WINDOW_MAX];
    // filled by dig_window_observe()
    double time_s[DIG_WINDOW_MAX];
    double value[DIG_WINDOW_MAX]; // of one channel after the other
    double progress[DIG_WINDOW_MAX];
    double smooth[DIG_WINDOW_MAX];
};

/// Remembers or keeps a sample. Constant time.
void dig_window_add(struct dig_window *window, const struct dig_window_sample *sample);

/// Opens the window with the samples remembered (they are copied: some microseconds); closes it and
/// forgets all.
void dig_window_open(struct dig_window *window);
void dig_window_close(struct dig_window *window);

/// Samples missing for longer than this, rig time, are a hole.
double dig_window_hole_s(double half_s);

/// The observation of the dig along route at the track's shift: samples from the start of the route
/// to its end (or to where the dig stopped), smoothed over +-half_s of rig time, read off at
/// DIG_CURVE_POINTS of progress where the furthest progress so far first reached them: a pause or a
/// step back changes nothing. A sample farther than limit_m from the route moves no progress.
/// sigma: white noise averages over the smoothing, the slow part does not. Of a dig that goes on,
/// only what is half_s old is told, and no ending; aborted is what left the route by more than
/// half of limit_m. Forces are told where all samples of the dig have them.
///
/// DIG_ENOMATCH when fewer than two points of the grid were reached, or samples are missing for
/// longer than half_s of rig time: what was not measured is not made up. Uses the window's own
/// arrays; O(samples * corners).
DIG_MUST_CHECK enum dig_status dig_window_observe(struct dig_window      *window,
                                                  const struct dig_route *route,
                                                  const struct dig_track *track, double limit_m,
                                                  double                  half_s,
                                                  struct dig_observation *observation);

#endif // DIG_ESTIMATOR_TRACK_WINDOW_H
