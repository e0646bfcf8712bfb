// Which gravel is known: from which dig, since when, until when, and whether the ground is still
// that. It outlives the daemon in a file, which is an identity as `digloop identify --json` writes
// it (files/identity_json.h), with the digs it was made of; how old it is, the file's modification
// time says.

#ifndef DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H
#define DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H

#include "core/error.h"
#include "estimator/estimator.h"
#include "estimator/match/pool.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_DRIFT_DIGS 2   // in a row that must differ before the ground counts as another
#define DIG_DRIFT_FAR  2.0 // times drift_floors: a simple dig so far off needs no second

struct dig_gravel_track_settings {
    double expires_s; // after the dig it came from
    double
        drift_floors; // a dig farther than this many noise floors from what was predicted differs
};

/// Zeroed: nothing is known, and never was.
struct dig_gravel_track {
    bool              any;   // a gravel was known once
    bool              valid; // and still is
    bool              restored;
    struct dig_match  match;
    char              trajectory[DIG_NAME_SIZE]; // of the dig it came from
    char              table[65];                 // scene hash
    struct dig_gravel nearest;
    struct dig_gravel weighted; // the entry of the least noise-weighted distance, if there is one
    int64_t           time_ns, expires_ns; // CLOCK_MONOTONIC
    double            drift;               // of the last dig compared, in noise floors; NaN: none
    int               differed;            // digs in a row that did
    char              wanted[96];          // what is to be done, for people; "" nothing
    double            path_measured;       // share of that dig's path; NaN: not known any more
    bool              going_on;            // that dig is not over
    enum dig_ending   ending;              // of that dig; not told after a restart

    struct dig_approach made, matched; // of that dig: struct dig_observation's made and approach
};

/// What is known from a match of digs of which dig is the youngest.
struct dig_gravel_track dig_gravel_track_of(const struct dig_curve_set   *set,
                                            const struct dig_match       *match,
                                            const struct dig_observation *dig, int64_t now_ns,
                                            const struct dig_gravel_track_settings *settings);

/// What a simple dig is to the ground that is known.
enum dig_gating {
    DIG_ACCEPTED, // of the same ground: to be matched together with the digs before
    DIG_HELD,     // it differs, and may be a chance: what is known stays, another is asked for
    DIG_REJECTED  // of another ground, or of the first
};

/// Compares a simple dig with what was expected of it. It is a stranger when nothing is known or
/// expected; when it differs by more than DIG_DRIFT_FAR * drift_floors; when it is one of
/// DIG_DRIFT_DIGS in a row that differ; or when it differs from a ground known from a single dig:
/// of two digs that contradict each other the younger counts. Remembers the drift.
enum dig_gating dig_gravel_track_judge(struct dig_gravel_track                *known,
                                       const struct dig_observation           *dig,
                                       const struct dig_expected              *expected,
                                       const struct dig_gravel_track_settings *settings);

/// Compares a dig that identifies nothing with what was expected of it. After DIG_DRIFT_DIGS in a
/// row that differ, what is known is known no longer. True when anything changed that is worth
/// telling. An observation of a trajectory without an expected curve changes nothing.
bool dig_gravel_track_watch(struct dig_gravel_track *known, const struct dig_observation *dig,
                            const struct dig_expected              *expected,
                            const struct dig_gravel_track_settings *settings);

/// It is known no longer, and why; a simple dig is asked for.
void dig_gravel_track_end(struct dig_gravel_track *known, const char *why);

/// True when it expired just now.
bool dig_gravel_track_age(struct dig_gravel_track *known, int64_t now_ns);

/// Writes all of it, with the digs (of trajectories of the set), or nothing. DIG_EIO: it cannot be
/// written (no room); the old file stands.
DIG_MUST_CHECK enum dig_status dig_gravel_track_write(const char                    *path,
                                                      const struct dig_gravel_track *known,
                                                      const struct dig_curve_set    *set,
                                                      const struct dig_pool         *pool,
                                                      struct dig_error              *error);

/// DIG_EINVAL: not an identity, of another table (scene hash) or of a gravel the table does not
/// have; DIG_ESTALE: older than settings->expires_s, or more than an hour younger than now (a wall
/// clock that was set back: its age cannot be known); DIG_EIO: it cannot be read, as when there is
/// none. A file that holds none of its digs leaves the pool empty: what is known stands until the
/// next simple dig begins anew. Writes on success only.
DIG_MUST_CHECK enum dig_status
dig_gravel_track_read(const char *path, const struct dig_curve_set *set, int64_t now_ns,
                      const struct dig_gravel_track_settings *settings,
                      struct dig_gravel_track *known, struct dig_pool *pool,
                      struct dig_error *error);

/// The same gravel judged by another table: nearest entry and untold axes anew. False when that
/// table does not hold it; *known is untouched then.
bool dig_gravel_track_move(struct dig_gravel_track *known, const struct dig_curve_set *set);

/// The trajectory that moves a kilogram with the least energy among those that fill the bucket at
/// least half as well as the best, or -1 when the table does not know what a bucket carries.
int dig_gravel_track_hint(const struct dig_curve_set *set, const struct dig_forecast *forecast,
                          double lambda, double *J_per_kg);

#endif // DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H
