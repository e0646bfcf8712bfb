// The table's summary beside the table, on the matching thread: made when a table is taken up, so
// that a dig is matched in milliseconds however large the table is.

#ifndef DIG_FIRMWARE_HOST_MATCHER_H
#define DIG_FIRMWARE_HOST_MATCHER_H

#include "estimator/match.h"
#include "estimator/summary.h"

/// Zeroed: no summary, and every curve is looked at.
struct dig_matcher {
    struct dig_outline *outline; // owned
    struct dig_summary  summary;
};

/// Sums a table up, in place of the one before; without the memory for it there is no summary then.
/// The set must outlive it, or dig_matcher_finish() comes first. A few microseconds a curve.
void dig_matcher_take_up(struct dig_matcher *matcher, const struct dig_curve_set *set);

/// As dig_match_nearest_pool() and dig_fit_refine_pool() of the set that was taken up, or, without
/// a summary, of any.
DIG_MUST_CHECK enum dig_status dig_matcher_nearest(const struct dig_matcher   *matcher,
                                                   const struct dig_curve_set *set, size_t digs,
                                                   const struct dig_observation dig[],
                                                   double outside_floors, struct dig_match *match);
DIG_MUST_CHECK enum dig_status dig_matcher_refine(const struct dig_matcher   *matcher,
                                                  const struct dig_curve_set *set, size_t digs,
                                                  const struct dig_observation dig[],
                                                  int max_evaluations, struct dig_match *match);

/// Frees the summary; zeroed then.
void dig_matcher_finish(struct dig_matcher *matcher);

#endif // DIG_FIRMWARE_HOST_MATCHER_H
