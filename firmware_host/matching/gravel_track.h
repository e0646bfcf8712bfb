// The tracked gravel: from which dig it is known, since when and until when, and whether new digs
// still agree with it. gravel_state.h keeps it over a restart.

#ifndef DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H
#define DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H

#include "core/gravel_match.h"
#include "core/observation.h"
#include "estimator/predict/forecast.h"

#include <stdbool.h>
#include <stdint.h>

/// Digs in a row that must differ before the ground counts as another: one alone may be chance.
#define DIG_TRACK_DRIFT_DIGS 2

/// A simple dig off by more than this many times drift_floors needs no second: chance does not
/// reach so far.
#define DIG_TRACK_DRIFT_FAR 2.0

struct dig_gravel_track_settings {
    double expires_s;    // lifetime of a match
    double drift_floors; // a dig farther from its forecast than this many noise floors differs
};

/// Zeroed: no gravel was ever known.
struct dig_gravel_track {
    bool              any;      // a gravel was known once
    bool              valid;    // and still is
    bool              restored; // from the state file
    struct dig_match  match;
    char              trajectory[DIG_NAME_SIZE]; // of the dig it came from
    char              table[65];                 // scene hash
    struct dig_gravel nearest;
    struct dig_gravel
                    weighted; // entry of the least noise-weighted distance, if match.weighted >= 0
    int64_t         time_ns, expires_ns; // CLOCK_MONOTONIC
    double          drift;               // of the last dig compared, in noise floors; NaN: none
    int             differed;            // digs in a row that differed
    char            wanted[96];          // what the operator should do; "": nothing
    double          path_measured;       // share of that dig's path; NaN: unknown after a restart
    bool            going_on;            // that dig is in progress: a provisional match
    enum dig_ending ending;              // of that dig; OPEN after a restart

    struct dig_approach made, matched; // of that dig: struct dig_observation's made and approach
};

/// The track of a match; dig is the youngest of the digs matched.
struct dig_gravel_track dig_gravel_track_make(const struct dig_curve_set   *set,
                                              const struct dig_match       *match,
                                              const struct dig_observation *dig, int64_t now_ns,
                                              const struct dig_gravel_track_settings *settings);

/// Gating of a dig that identifies.
enum dig_gating {
    DIG_ACCEPTED, // same ground: matched together with the digs before it
    DIG_HELD,     // differs, perhaps by chance: the track stays, another dig is wanted
    DIG_REJECTED  // other ground, or the first: matched alone
};

/// Gates a dig by its distance from its forecast, and records the drift. Rejected when
///   * no gravel is known, or the dig has no forecast;
///   * it is off by more than DIG_TRACK_DRIFT_FAR * drift_floors;
///   * it is one of DIG_TRACK_DRIFT_DIGS in a row that differ;
///   * it differs from a track of a single dig: of two digs that disagree the younger counts.
enum dig_gating dig_gravel_track_gate(struct dig_gravel_track                *track,
                                      const struct dig_observation           *dig,
                                      const struct dig_expected              *expected,
                                      const struct dig_gravel_track_settings *settings);

/// Compares a dig that does not identify with its forecast. DIG_TRACK_DRIFT_DIGS in a row that
/// differ invalidate the track. True when the track changed; false, and unchanged, without a
/// forecast.
bool dig_gravel_track_compare(struct dig_gravel_track *track, const struct dig_observation *dig,
                              const struct dig_expected              *expected,
                              const struct dig_gravel_track_settings *settings);

/// Invalidates the track and asks for a simple dig, for the reason given.
void dig_gravel_track_invalidate(struct dig_gravel_track *track, const char *why);

/// Invalidates a track past its expiry; true when it did.
bool dig_gravel_track_expire(struct dig_gravel_track *track, int64_t now_ns);

/// Moves the track to another table of the same scene: finds nearest entry and undetermined axes
/// again. False, and unchanged, when the table does not cover the gravel.
bool dig_gravel_track_set_table(struct dig_gravel_track *track, const struct dig_curve_set *set);

/// The trajectory that moves a kilogram with the least energy, of those that fill the bucket at
/// least half as well as the best. -1 where the table does not hold the load carried.
int dig_gravel_track_hint(const struct dig_curve_set *set, const struct dig_forecast *forecast,
                          double lambda, double *J_per_kg);

#endif // DIG_FIRMWARE_HOST_MATCHING_GRAVEL_TRACK_H
