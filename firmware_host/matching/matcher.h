// Matches digs with the table in use. For a table dug at several depths and attacks, the table at
// those of the digs (estimator/approach/approach_slots.h) is made for every match.

#ifndef DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHING_MATCHER_H

#include "estimator/approach/approach_error.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/predict/forecast.h"

/// Zeroed: of a table dug at one depth and attack.
struct dig_matcher {
    // For a table dug at several depths and attacks: errors of the interpolation between them.
    bool                      varies;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    void                     *memory; // owned, of the table last made
    size_t                    bytes;
    struct dig_observation    dig[DIG_POOL_MAX];
};

/// Takes a table in place of the one before.
void dig_matcher_set_table(struct dig_matcher *matcher, const struct dig_curve_set *set);

/// Tells the depth of a dig as it was observed: dig_depth_fit() in the matcher's memory.
/// DIG_ENOMEM, too.
DIG_MUST_CHECK enum dig_status dig_matcher_fit_depth(struct dig_matcher         *matcher,
                                                     const struct dig_curve_set *set,
                                                     double limit_m, struct dig_observation *dig);

/// As dig_match_nearest() and dig_fit_refine() of the matcher's table; each dig with the curves of
/// its own depth and attack. DIG_ENOMEM: no memory for these.
DIG_MUST_CHECK enum dig_status dig_matcher_nearest(struct dig_matcher         *matcher,
                                                   const struct dig_curve_set *set, size_t digs,
                                                   const struct dig_observation dig[],
                                                   double outside_floors, struct dig_match *match);
DIG_MUST_CHECK enum dig_status dig_matcher_refine(struct dig_matcher         *matcher,
                                                  const struct dig_curve_set *set, size_t digs,
                                                  const struct dig_observation dig[],
                                                  int max_evaluations, struct dig_match *match);

/// The forecast of a dig as it was dug: dig_forecast_as_dug() in the matcher's memory. valid =
/// false without memory.
void dig_matcher_expect(struct dig_matcher *matcher, const struct dig_curve_set *set, double lambda,
                        const struct dig_match *match, size_t trajectory,
                        const struct dig_approach *approach, struct dig_expected *expected);

/// Frees its memory; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
