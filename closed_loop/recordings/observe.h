// A force recording as the matcher wants it: moment and forces over path progress, smoothed, on the
// table's grid.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H
#define DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"

#include <stdbool.h>

/// A recording whose path is farther than this (rms, in bucket lengths) from every trajectory of
/// the table is not one of its digs.
#define DIG_OBSERVE_PATH_LIMIT 0.05

/// A dig of a force recording on the table's grid, rig scale: every channel there is.
struct dig_observed {
    int                 trajectory;
    double              off_path_m;
    struct dig_approach made; // as the way tells it; the depth only of dig_observe_as_dug(), else 1
    struct dig_approach approach;    // the nearest to that the table holds
    double deeper[DIG_CURVE_POINTS]; // recordings/path_depth.h; zeros of dig_observe_as_dug()
    double pace;                     // duration of the table's trajectory / of this dig
    double first,
        last; // progress range that was recorded: 0 and 1 but for a few hundredths of a second
    bool   measured[DIG_FORCE_CHANNELS];
    double value[DIG_FORCE_CHANNELS]
                [DIG_CURVE_POINTS]; // smoothed; 0 where not measured, and outside that range
    double sigma[DIG_FORCE_CHANNELS]
                [DIG_CURVE_POINTS]; // of that, by the rows: recordings/reading_noise.h
};

/// Finds the trajectory the recording followed, at its own pace and at least six tenths of it, and
/// samples its channels, smoothed over the path that the table's dig makes in +-set->smooth_half_s,
/// at DIG_CURVE_POINTS of its path progress. The recording must be of the table's size (rig scale);
/// where it stands in space does not matter. The bucket may be turned against the trajectory as far
/// as the table was dug so. A force that rows lack for longer than is smoothed is not measured.
///
/// DIG_ENOMATCH: no trajectory of the set within DIG_OBSERVE_PATH_LIMIT; *error names the nearest
/// and its distance. DIG_EINVAL: a recording that does not move, or lacks the moment. DIG_ENOMEM.
/// O(rows).
DIG_MUST_CHECK enum dig_status dig_observe_dig(const struct dig_curve_set *set,
                                               const struct dig_recording *recording,
                                               struct dig_observed        *observed,
                                               struct dig_error           *error);

/// The same of a dig that may be deeper than the table's or have the bucket turned, where the table
/// was dug so along its trajectory (estimator/approach/approaches.h): depth and attack are told
/// from the way, which begins with the recording. What of them lies beyond what the table was dug
/// at counts as distance from the path, in quadrature with the rest.
DIG_MUST_CHECK enum dig_status dig_observe_as_dug(const struct dig_curve_set *set,
                                                  const struct dig_recording *recording,
                                                  struct dig_observed        *observed,
                                                  struct dig_error           *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H
