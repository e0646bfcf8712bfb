// Matches digs with the table in use, by a prefilter that is made when the table changes: a dig is
// matched in milliseconds however large the table is. For a table dug at several depths and
// attacks, the table at those of the digs (estimator/approach/approach_slots.h) is made for every
// match.

#ifndef DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHING_MATCHER_H

#include "estimator/approach/approach_error.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"
#include "estimator/predict/forecast.h"

/// Zeroed: no prefilter, every curve is compared.
struct dig_matcher {
    struct dig_outline  *outline; // owned
    struct dig_prefilter prefilter;
    // For a table dug at several depths and attacks: errors of the interpolation between them.
    bool                      varies;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    void                     *memory; // owned, of the table last made
    size_t                    bytes;
    struct dig_observation    dig[DIG_POOL_MAX];
};

/// Makes the prefilter of a table, in place of the one before; without memory there is none. The
/// set must outlive it, or dig_matcher_finish() comes first. A few microseconds a curve.
void dig_matcher_set_table(struct dig_matcher *matcher, const struct dig_curve_set *set);

/// Tells the depth of a dig as it was observed: dig_depth_fit() in the matcher's memory.
/// DIG_ENOMEM, too.
DIG_MUST_CHECK enum dig_status dig_matcher_fit_depth(struct dig_matcher         *matcher,
                                                     const struct dig_curve_set *set,
                                                     double limit_m, struct dig_observation *dig);

/// As dig_match_nearest() and dig_fit_refine() of the matcher's table (without a prefilter, of
/// any); each dig with the curves of its own depth and attack. DIG_ENOMEM: no memory for these.
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

/// Frees the prefilter; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
