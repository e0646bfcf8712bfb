// Observes a recorded dig: its trajectory, and its moment along it. For the matching thread and
// offline tools.

#ifndef DIG_ESTIMATOR_APPROACH_OBSERVE_DIG_H
#define DIG_ESTIMATOR_APPROACH_OBSERVE_DIG_H

#include "core/curve.h"
#include "core/observation.h"
#include "estimator/track/recorded_dig.h"
#include "estimator/track/settings.h"

#include <stdbool.h>

/// Fits the path to every trajectory of the set, and observes the moment along the one it was.
/// Where the table holds several depths of it, over the path at a depth beyond them all, which is
/// then `approach`, with a rough depth in `made`: dig_depth_fit() (estimator/match/depth.h) tells
/// the depth. DIG_ENOMATCH: it was none of them, or too little of one. Sorts the recording's
/// samples; one to two milliseconds.
DIG_MUST_CHECK enum dig_status
dig_recorded_dig_observe(const struct dig_curve_set          *set,
                         const struct dig_estimator_settings *settings,
                         struct dig_recorded_dig *recording, struct dig_observation *observation);

/// For a dig that dig_recorded_dig_observe() refused: true when it followed a trajectory of the set
/// and left it before its end; then *trajectory and *progress say which and where. Its moment is
/// not observed, as the way out belongs to its path. Some milliseconds.
bool dig_recorded_dig_was_aborted(const struct dig_curve_set          *set,
                                  const struct dig_estimator_settings *settings,
                                  const struct dig_recorded_dig *recording, int *trajectory,
                                  double *progress);

#endif // DIG_ESTIMATOR_APPROACH_OBSERVE_DIG_H
