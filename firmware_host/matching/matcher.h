// The table's summary beside the table, on the matching thread: made when a table is taken up, so
// that a dig is matched in milliseconds however large the table is. Of a table dug at several
// depths and attacks, the one at those of the digs (estimator/approach/approach_slots.h) is made
// for every match.

#ifndef DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHING_MATCHER_H

#include "estimator/approach/approach_error.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/match/prefilter.h"
#include "estimator/predict/forecast.h"

/// Zeroed: no summary, and every curve is looked at.
struct dig_matcher {
    struct dig_outline  *outline; // owned
    struct dig_prefilter prefilter;
    // Where the table was dug in several ways along a trajectory: how wrong what lies between is.
    bool                      varies;
    struct dig_approach_error error[DIG_TRAJECTORY_MAX];
    void                     *memory; // owned, of the table last made
    size_t                    bytes;
    struct dig_observation    dig[DIG_POOL_MAX];
};

/// Sums a table up, in place of the one before; without the memory for it there is no summary then.
/// The set must outlive it, or dig_matcher_finish() comes first. A few microseconds a curve.
void dig_matcher_set_table(struct dig_matcher *matcher, const struct dig_curve_set *set);

/// As dig_match_nearest() and dig_fit_refine() of the set that was taken up, or, without
/// a summary, of any; each dig with the curves of its own depth and attack. DIG_ENOMEM: there is
/// no memory for these.
DIG_MUST_CHECK enum dig_status dig_matcher_nearest(struct dig_matcher         *matcher,
                                                   const struct dig_curve_set *set, size_t digs,
                                                   const struct dig_observation dig[],
                                                   double outside_floors, struct dig_match *match);
DIG_MUST_CHECK enum dig_status dig_matcher_refine(struct dig_matcher         *matcher,
                                                  const struct dig_curve_set *set, size_t digs,
                                                  const struct dig_observation dig[],
                                                  int max_evaluations, struct dig_match *match);

/// What is expected of a dig made so: dig_forecast_as_dug() in the matcher's memory. valid = false
/// without the memory.
void dig_matcher_expect(struct dig_matcher *matcher, const struct dig_curve_set *set, double lambda,
                        const struct dig_match *match, size_t trajectory,
                        const struct dig_approach *approach, struct dig_expected *expected);

/// Frees the summary; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHING_MATCHER_H
