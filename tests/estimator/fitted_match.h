// The gravel that digs show, as the daemon finds it: the nearest entry, and the fit from there.

#ifndef DIG_TESTS_ESTIMATOR_FITTED_MATCH_H
#define DIG_TESTS_ESTIMATOR_FITTED_MATCH_H

#include "estimator/match/match.h"
#include "tests/testlib.h"

static inline struct dig_match fit(const struct dig_curve_set *const set, const size_t digs,
                                   const struct dig_observation dig[])
{
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, digs, dig, 2.5, &match), DIG_OK);
    assert_int_equal(dig_fit_refine(set, digs, dig, 100, &match), DIG_OK);
    return match;
}

#endif // DIG_TESTS_ESTIMATOR_FITTED_MATCH_H
