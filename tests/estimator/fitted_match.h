// The gravel that digs show, as the daemon finds it, and how often its intervals hold.

#ifndef DIG_TESTS_ESTIMATOR_FITTED_MATCH_H
#define DIG_TESTS_ESTIMATOR_FITTED_MATCH_H

#include "estimator/match/match.h"
#include "tests/testlib.h"

/// The nearest entry, and the fit from there.
static inline struct dig_match fit(const struct dig_curve_set *const set, const size_t digs,
                                   const struct dig_observation dig[], const int evaluations)
{
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, digs, dig, 2.5, &match), DIG_OK);
    assert_int_equal(dig_fit_refine(set, digs, dig, evaluations, &match), DIG_OK);
    assert_int_equal(match.digs, digs);
    return match;
}

/// Matches of gravels that are known: how many of their intervals hold them, and how wide these
/// are in all.
struct held {
    int    trials, in[DIG_AXES];
    double width[DIG_AXES];
};

static inline void held_add(struct held *const held, const struct dig_match *const match,
                            const struct dig_gravel *const truth)
{
    held->trials++;
    for (int a = 0; a < DIG_AXES; a++) {
        const double v = truth->value[a];
        held->in[a] += v >= match->low.value[a] && v <= match->high.value[a] ? 1 : 0;
        held->width[a] += match->high.value[a] - match->low.value[a];
    }
}

/// Nine in ten hold, along the first axes, or somewhat more: the likelihood counts by 0.7, so where
/// all is as it assumes 95 % lie in an interval of 90 %. Three standard deviations of a binomial
/// count.
static inline void held_expect(const struct held *const held, const int axes,
                               const char *const what)
{
    const int n = held->trials;
    for (int a = 0; a < axes; a++) {
        const double share = (double)held->in[a] / n;
        print_message("%s, axis %d: %d of %d in the interval, mean width %.3f\n", what, a,
                      held->in[a], n, held->width[a] / n);
        assert_true(share > 0.9 - 3.0 * sqrt(0.9 * 0.1 / n) &&
                    share < 0.95 + 3.0 * sqrt(0.95 * 0.05 / n));
    }
}

#endif // DIG_TESTS_ESTIMATOR_FITTED_MATCH_H
