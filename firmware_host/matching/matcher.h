// Matches digs with the table in use. For a table dug at several depths and attacks, the table at
// those of the digs (estimator/approach/approach_slots.h) is made for every match.
//
// A table lives until no thread reads it: after an exchange the matching thread uses the new one at
// once, the tick from its next pause between two digs, the publisher with the tick. Each says by a
// generation number which table it uses; the old table is freed when both have reached the new one.

#ifndef DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHING_MATCHER_H

#include "estimator/approach/approach_error.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/predict/forecast.h"

#include <stdatomic.h>

/// Zeroed but for the two atomics: of no table.
struct dig_matcher {
    const atomic_llong *tick_generation;      // in use by the tick
    const atomic_llong *publisher_generation; // in use by the publisher

    struct dig_curve_set *set;        // owned
    struct dig_curve_set *retiring;   // the one before, while a thread may read it; owned; or NULL
    int64_t               generation; // of set, counted from 1
    double                lambda;     // machine's tooth length / set's

    // For a table dug at several depths and attacks: errors of the interpolation between them.
    bool                      varies;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    void                     *memory; // owned, of the table last made
    size_t                    bytes;
    struct dig_observation    dig[DIG_POOL_MAX];
};

/// Takes the set over as the next generation. Only while retiring is NULL.
void dig_matcher_exchange(struct dig_matcher *matcher, struct dig_curve_set *set, double lambda);

/// True when the tick uses the current generation.
bool dig_matcher_is_of_tick(const struct dig_matcher *matcher);

/// Frees the table before once tick and publisher use the current one.
void dig_matcher_retire(struct dig_matcher *matcher);

/// Tells the depth of a dig as it was observed: dig_depth_fit() in the matcher's memory.
/// DIG_ENOMEM, too.
DIG_MUST_CHECK enum dig_status dig_matcher_fit_depth(struct dig_matcher *matcher, double limit_m,
                                                     struct dig_observation *dig);

/// Matches digs, each with the curves of its own depth and attack: dig_match_nearest(),
/// dig_match_find_weighted() and dig_fit_refine(). Fails as the first of them does, and with
/// DIG_ENOMEM. *refined: how the last went; where it failed the nearest entry stands.
DIG_MUST_CHECK enum dig_status dig_matcher_match(struct dig_matcher *matcher, size_t digs,
                                                 const struct dig_observation dig[],
                                                 double outside_floors, int max_evaluations,
                                                 struct dig_match *match, enum dig_status *refined);

/// The forecast of a dig as it was dug: dig_forecast_as_dug() in the matcher's memory. valid =
/// false without memory.
void dig_matcher_expect(struct dig_matcher *matcher, const struct dig_match *match,
                        size_t trajectory, const struct dig_approach *approach,
                        struct dig_expected *expected);

/// Frees both tables and its memory; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
