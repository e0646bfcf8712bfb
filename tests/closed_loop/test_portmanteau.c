#include "closed_loop/search/portmanteau.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 6 };

static const struct dig_gravel  gravel = { { 0.6, 0.55, 2500 } };
static struct dig_whitened_digs batch;
static struct dig_measured      measured[DIGS];

// Three simple and three real digs of a gravel that coheres, which none of the table does.
static struct dig_whiteness judge(const double magnitude, uint64_t seed)
{
    const enum dig_effect_id cohesion = DIG_EFFECT_COHESION;
    dig_in_turn(DIGS, &gravel, 1, &cohesion, &magnitude, &seed, measured);
    batch_digs(DIGS, measured, &gravel, &batch);
    const struct dig_fitted    plain = fit_plain(&batch);
    const struct dig_whiteness white =
        dig_portmanteau_judge(&batch, &plain, test_is_quick() ? 19 : 99, seed);
    assert_int_equal(white.digs, DIGS);
    return white;
}

// Worked out on paper: r = -9/10, 8/10, -7/10; 10 * 12 * (.81 / 9 + .64 / 8 + .49 / 7).
TEST(numbers_that_alternate_are_28_point_8)
{
    const double z[] = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };
    assert_close(dig_portmanteau(10, z), 28.8, 1e-9);
    // One that stands alone is correlated with nothing; scale does not matter.
    const double lone[] = { 0.0, 0.0, 5.0, 0.0, 0.0 };
    const double pair[] = { 2.0, 2.0 };
    const double same[] = { 7.0, 7.0 };
    assert_close(dig_portmanteau(5, lone), 0.0, 0.0);
    assert_close(dig_portmanteau(2, pair), 2.0 * 4.0 * 0.25, 1e-12);
    assert_close(dig_portmanteau(2, same), dig_portmanteau(2, pair), 1e-12);
    assert_close(dig_portmanteau(1, pair), 0.0, 0.0);
    assert_close(dig_portmanteau(0, NULL), 0.0, 0.0);
}

TEST(digs_that_lack_nothing_are_white)
{
    enum { CAMPAIGNS = 40 };
    int small = 0;
    int large = 0;
    for (uint64_t c = 0; c < CAMPAIGNS; c++) {
        const struct dig_whiteness w = judge(0.0, 100 + c);
        small += w.p < 0.1 ? 1 : 0;
        large += w.p > 0.5 ? 1 : 0;
        assert_true(w.low <= w.statistic && w.statistic <= w.high);
    }
    // Binomial: 4 of 40 expected below .1, more than 11 with a chance below 1e-3; 20 above .5,
    // fewer than 10 or more than 30 likewise.
    assert_true(small <= 11);
    assert_true(large >= 10 && large <= 30);
}

TEST(what_lasts_along_the_dig_is_not_white)
{
    for (uint64_t c = 0; c < 5; c++) {
        const struct dig_whiteness w = judge(0.8, 200 + c);
        assert_true(w.p <= 0.05);
        assert_true(w.statistic > w.expected);
        assert_true(w.low < w.high);
    }
}

TESTS_WITH(world_setup, world_teardown)
