// The matching thread: recorded digs in, gravel and forecast out. It also exchanges the table on
// request. It allocates (NLopt, SQLite), so it runs beside the tick, never in it.
//
//   digs ------> observe -> gate -> match -> track ---> basis ----> tick
//   estimates -> observe the dig in progress -> provisional   `---> results -> publisher

#ifndef DIG_FIRMWARE_HOST_MATCHING_FIT_H
#define DIG_FIRMWARE_HOST_MATCHING_FIT_H

#include "estimator/match/pool.h"
#include "firmware_host/config/config.h"
#include "firmware_host/matching/early_match.h"
#include "firmware_host/matching/gravel_track.h"
#include "firmware_host/matching/matcher.h"
#include "firmware_host/tick/loop.h"

#include <stdatomic.h>

/// The gravel for the publisher. A copy: it holds whatever table is in use.
struct dig_fit_result {
    struct dig_gravel_track track;
    char                    hint_trajectory[DIG_NAME_SIZE]; // "": none
    double                  hint_J_per_kg;
};

/// A table in use, for the publisher.
struct dig_table_update {
    const struct dig_curve_set *set;
    int64_t                     generation;
};

/// Written by the matching thread, read by others. Never reset.
struct dig_fit_counters {
    atomic_llong seen;           // digs taken from the queue
    atomic_llong matches;        // digs matched
    atomic_llong whole, aborted; // digs, by how they ended
    atomic_llong unknown;        // digs along no trajectory of the table
    atomic_llong reloads, reloads_refused;
};

/// What it owns is its matcher's.
struct dig_fit {
    // fixed at start
    const char                      *config_path; // read again on a reload
    const struct dig_config         *config;
    const struct dig_machine        *machine; // NULL: no inertia is taken off
    struct dig_gravel_track_settings track_settings;
    struct dig_handoffs             *handoffs;
    const atomic_bool               *stop;

    // shared with other threads
    atomic_bool             reload; // request; cleared by the thread
    atomic_bool             busy;   // a turn is in progress
    struct dig_fit_counters count;

    // the thread's own
    struct dig_matcher          matcher;
    struct dig_early_match     *early;
    struct dig_gravel_track     track;
    struct dig_pool             pool;         // digs the track is matched from
    struct dig_prediction_basis basis;        // last one published to the tick
    bool                        basis_as_dug; // its forecast is adapted to the dig in progress
    struct dig_expected         expected;     // scratch: forecast of a dig as it was dug
};

/// Restores the gravel from the state file, if there is one, and publishes it. Before the thread
/// starts. A bad file is logged; the gravel is then not known.
void dig_fit_restore(struct dig_fit *fit);

/// Takes one observed dig. One that identifies is gated (dig_gravel_track_gate) and matched with
/// the digs before it or alone; any other is compared with what was forecast.
void dig_fit_take(struct dig_fit *fit, const struct dig_observation *dig);

/// One turn: table, age of the gravel, dig in progress, one finished dig. True when there was a
/// finished dig. A provisional match is published, and predicted from only while no gravel is
/// known; it is not saved, and it ends with its dig.
bool dig_fit_once(struct dig_fit *fit);

/// The thread: a turn every 20 ms until *stop.
void dig_fit_run(struct dig_fit *fit);

#endif // DIG_FIRMWARE_HOST_MATCHING_FIT_H
