// The matching thread: digs that are finished go in as the tick recorded them, gravels and what
// they will resist with come out. It also exchanges the table when asked to. Allocates (in NLopt,
// in SQLite), so it lives beside the tick, never in it.

#ifndef DIG_FIRMWARE_HOST_MATCHING_FIT_H
#define DIG_FIRMWARE_HOST_MATCHING_FIT_H

#include "estimator/match/match.h"
#include "firmware_host/config/config.h"
#include "firmware_host/matching/early_match.h"
#include "firmware_host/matching/gravel_track.h"
#include "firmware_host/matching/matcher.h"
#include "firmware_host/tick/loop.h"

#include <stdatomic.h>

/// What is known, for the publisher; whole in itself, whatever table is in use.
struct dig_fit_result {
    struct dig_gravel_track known;
    char                    hint_trajectory[DIG_NAME_SIZE]; // "" not known
    double                  hint_J_per_kg;
};

/// A table in use, for the publisher's names.
struct dig_table_news {
    const struct dig_curve_set *set;
    int64_t                     generation;
};

struct dig_fit {
    const char                      *config_path; // read again for a reload
    const struct dig_config         *config;
    const struct dig_machine        *machine;
    struct dig_curve_set            *set;        // in use; owned
    struct dig_curve_set            *retiring;   // the one before, until no one looks at it; owned
    int64_t                          generation; // of set, counted from 1
    double                           lambda;
    struct dig_gravel_track_settings known_settings;
    struct dig_ring                 *digs;   // in:  struct dig_recorded_dig *
    struct dig_ring                 *spares; // out: the same memory, back
    struct dig_early_match *early;   // in:  the dig going on; NULL: digs are matched when over
    struct dig_latest      *offer;   // out: struct dig_offer, to the tick
    struct dig_latest      *table;   // out: struct dig_offer of another table, to the tick
    struct dig_ring        *results; // out: struct dig_fit_result, to the publisher
    struct dig_latest      *tables;  // out: struct dig_table_news, to the publisher
    struct dig_latest      *notes;   // out: struct dig_note, what went wrong
    const atomic_bool      *stop;
    const atomic_llong     *tick_generation;    // that the tick uses
    const atomic_llong     *publish_generation; // that the publisher uses
    atomic_bool             reload;             // asked for; taken by the thread
    atomic_llong            seen;               // digs taken
    atomic_llong            matches;            // digs matched
    atomic_llong            whole, aborted;     // digs taken, by how they ended
    atomic_llong            unknown;            // digs along none of the table's trajectories
    atomic_llong            reloads, reloads_refused;
    atomic_bool             busy;

    // the thread's own
    struct dig_matcher      matcher; // of set; zeroed: without a summary
    struct dig_gravel_track known;
    struct dig_gravel_track hunch; // of the dig going on
    struct dig_pool         pool;  // the digs it is known from; none: restored without them
    struct dig_offer        next;  // what is offered
    bool                    dug;   // it is of the dig going on, as that is dug
    struct dig_expected     own;   // what was expected of a dig as it was dug
};

/// Takes up what the state file knows, if there is one, and offers it. Before the thread starts.
/// What is wrong with the file is noted, no error: the daemon then knows nothing.
void dig_fit_restore(struct dig_fit *fit);

/// One dig as observed. Of a trajectory that does not identify: compared with what was expected.
/// Of one that does: matched together with the digs before when it is of their ground, by itself
/// when it is of another (dig_gravel_track_judge).
void dig_fit_take(struct dig_fit *fit, const struct dig_observation *dig);

/// One turn: a dig that waits in the ring, the dig going on, a reload asked for, what is too old.
/// True when a dig was taken. What the dig going on tells (a hunch) is published; it is predicted
/// from only while nothing else is known; nothing of it is kept, and it ends with the dig.
bool dig_fit_once(struct dig_fit *fit);

/// The thread: a turn every 20 ms until *stop.
void dig_fit_run(struct dig_fit *fit);

/// Frees the tables.
void dig_fit_finish(struct dig_fit *fit);

#endif // DIG_FIRMWARE_HOST_MATCHING_FIT_H
