// The dig going on, as the matching thread sees it: what the tick tells is kept
// (estimator/approach/live_recording.h) and looked at again and again while the dig moves on.

#ifndef DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H
#define DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H

#include "estimator/approach/live_recording.h"
#include "firmware_host/config/config.h"
#include "firmware_host/threads/handoff.h"

#define DIG_EARLY_MATCH_STEP 0.1  // of the path between two looks
#define DIG_EARLY_MATCH_s    30.0 // how long what was seen may be used

/// Zeroed but for estimates and forgotten once: no dig goes on. About 4.5 MB.
struct dig_early_match {
    struct dig_ring    *estimates; // in: struct dig_estimate, every one the tick made
    struct dig_estimate last;
    double              next; // progress at which the dig is looked at again
    int                 off;  // trajectory of the table it was along, dug as the table was not; -1
    struct dig_live_recording shadow;
    struct dig_recorded_dig   scratch;
};

/// Forgets the dig going on. At start, and when the table becomes another.
void dig_early_match_forget(struct dig_early_match *early, const struct dig_curve_set *set);

/// Takes up what the tick told since the last turn. True when the dig going on is worth a look: of
/// a trajectory that identifies or that the table was dug along in several ways, at least
/// match_early_path of it measured, and DIG_EARLY_MATCH_STEP farther than at the last look.
/// early->off says when a look saw a dig off the table. Then *dig is what was dug so far; a look is
/// two to three milliseconds.
bool dig_early_match_look(struct dig_early_match *early, const struct dig_curve_set *set,
                          double lambda, const struct dig_config *config,
                          struct dig_observation *dig);

#endif // DIG_FIRMWARE_HOST_MATCHING_EARLY_MATCH_H
