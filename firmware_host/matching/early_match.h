// Observation of the dig in progress on the matching thread: records the tick's estimates
// (estimator/approach/live_recording.h) and observes the dig again and again while it advances.

#ifndef DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H
#define DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H

#include "estimator/approach/live_recording.h"
#include "firmware_host/config/config.h"
#include "firmware_host/matching/gravel_track.h"
#include "firmware_host/threads/handoff.h"

/// Progress between two observations of one dig: one takes two to three milliseconds, in a table of
/// several depths 1.5 ms an entry more, and less of a path changes a match little.
#define DIG_EARLY_MATCH_STEP 0.1

/// Lifetime of a provisional match: longer than a dig takes.
#define DIG_EARLY_MATCH_s 30.0

/// Zeroed but for estimates, then cleared: no dig in progress. About 4 MB.
struct dig_early_match {
    struct dig_ring    *estimates; // in: struct dig_estimate, one a tick
    struct dig_estimate last;
    double              next_progress;        // where the dig is observed again
    int                 off_table_trajectory; // the one it is dug along, as the table was not; -1

    struct dig_live_recording live;
    struct dig_recorded_dig   scratch;
    struct dig_gravel_track   provisional; // from the dig in progress; ends with it
};

/// Drops the dig in progress. Required at start and when the table changes.
void dig_early_match_clear(struct dig_early_match *early, const struct dig_curve_set *set);

/// Records the estimates that came. Then observes the dig in progress if it is due: its trajectory
/// identifies or was dug in several ways for the table, at least match_early_path of it was
/// measured, and it advanced DIG_EARLY_MATCH_STEP since the last observation. True when *dig was
/// written. Sets off_table_trajectory. machine: whose inertia is taken off; NULL: none. stated: its
/// friction, as dig_inertia_take_off() has it.
bool dig_early_match_observe(struct dig_early_match *early, const struct dig_curve_set *set,
                             double lambda, const struct dig_machine *machine,
                             const struct dig_friction stated[], const struct dig_config *config,
                             struct dig_observation *dig);

#endif // DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H
