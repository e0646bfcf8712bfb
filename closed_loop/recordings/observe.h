// A force recording as the matcher wants it: moment and forces over path progress, smoothed, on the
// table's grid.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H
#define DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H

#include "closed_loop/recordings/measured.h"
#include "core/error.h"
#include "core/recording.h"

/// A recording whose path is farther than this (rms, in bucket lengths) from every trajectory of
/// the table is not one of its digs.
#define DIG_OBSERVE_PATH_LIMIT 0.05

/// Finds the trajectory the recording followed, at its own pace and at least six tenths of it, and
/// samples its channels, smoothed over the path that the table's dig makes in +-set->smooth_half_s,
/// at DIG_CURVE_POINTS of its path progress. The recording must be of the table's size (rig scale);
/// where it stands in space does not matter. The bucket may be turned against the trajectory as far
/// as the table was dug so. A force that rows lack for longer than is smoothed is not measured. Of
/// *observed is written what the recording tells: the way, made (its depth 1), approach, deeper,
/// pace, the channels, the progress recorded, which lacks but hundredths of a second, and sigma by
/// the rows (recordings/reading_noise.h).
///
/// DIG_ENOMATCH: no trajectory of the set within DIG_OBSERVE_PATH_LIMIT; *error names the nearest
/// and its distance. DIG_EINVAL: a recording that does not move, lacks the moment, or is of
/// another unit (recordings/force_check.h). DIG_ENOMEM.
/// O(rows).
DIG_MUST_CHECK enum dig_status dig_observe_dig(const struct dig_curve_set *set,
                                               const struct dig_recording *recording,
                                               struct dig_measured        *observed,
                                               struct dig_error           *error);

/// The same of a dig that may be deeper than the table's or have the bucket turned, where the table
/// was dug so along its trajectory (estimator/approach/approaches.h): depth and attack are told
/// from the way, which begins with the recording. What of them lies beyond what the table was dug
/// at counts as distance from the path, in quadrature with the rest. deeper is zeros.
DIG_MUST_CHECK enum dig_status dig_observe_as_dug(const struct dig_curve_set *set,
                                                  const struct dig_recording *recording,
                                                  struct dig_measured        *observed,
                                                  struct dig_error           *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_OBSERVE_H
