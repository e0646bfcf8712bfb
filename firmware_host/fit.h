// The matching thread: digs that are finished go in, gravels come out. Allocates (in NLopt), so it
// lives beside the tick, never in it.

#ifndef DIG_FIRMWARE_HOST_FIT_H
#define DIG_FIRMWARE_HOST_FIT_H

#include "estimator/match.h"
#include "firmware_host/config.h"

#include <stdatomic.h>

/// A match, and what it was made from; for the publisher.
struct dig_fit_result {
    struct dig_match match;
    int64_t          time_ns; // CLOCK_MONOTONIC
    int              trajectory;
};

struct dig_fit {
    const struct dig_config    *config;
    const struct dig_curve_set *set;
    struct dig_ring            *digs;    // in:  struct dig_observation
    struct dig_latest          *match;   // out: struct dig_match, to the tick
    struct dig_ring            *results; // out: struct dig_fit_result, to the publisher
    struct dig_latest          *notes;   // out: struct dig_note, why a dig gave no match
    const atomic_bool          *stop;
    atomic_llong                seen;    // digs taken
    atomic_llong                matches; // digs matched
    atomic_bool                 busy;
};

/// Takes what waits in the ring; true when there was a dig. Digs of trajectories that do not
/// identify are passed over.
bool dig_fit_once(struct dig_fit *fit);

/// The thread: looks every 20 ms until *stop.
void dig_fit_run(struct dig_fit *fit);

#endif // DIG_FIRMWARE_HOST_FIT_H
