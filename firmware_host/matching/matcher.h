// Matches digs with the table in use. For a table dug at several depths and attacks, the table at
// those of the digs (estimator/approach/approach_slots.h) is made for every match.

#ifndef DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHING_MATCHER_H

#include "estimator/approach/approach_error.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/predict/forecast.h"

/// Zeroed: of no table.
struct dig_matcher {
    const struct dig_curve_set *set;
    // For a table dug at several depths and attacks: errors of the interpolation between them.
    bool                      varies;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    void                     *memory; // owned, of the table last made
    size_t                    bytes;
    struct dig_observation    dig[DIG_POOL_MAX];
};

/// Takes a table, which must outlive its use, in place of the one before.
void dig_matcher_set_table(struct dig_matcher *matcher, const struct dig_curve_set *set);

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
void dig_matcher_expect(struct dig_matcher *matcher, double lambda, const struct dig_match *match,
                        size_t trajectory, const struct dig_approach *approach,
                        struct dig_expected *expected);

/// Frees its memory; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
