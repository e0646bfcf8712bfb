// Test for estimator/match/posterior.c: gravels all over the grid of tables/product.sqlite, in one
// bed each that is in no table (tests/data/product/spread), told by one dig of simpleA.

#include "estimator/approach/interpolate.h"
#include "estimator/match/posterior.h"
#include "tests/table_runs.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>

struct tally {
    int    digs, in[DIG_AXES];
    double off2[DIG_AXES]; // of the mean, as shares of the axis
};

static void tell(const struct dig_curve_set *const table, const char *const path,
                 struct tally *const tally)
{
    static struct dig_pool_sums sums;
    struct table_runs *const    all   = calloc(1, sizeof *all);
    struct dig_error            error = { "" };
    assert_non_null(all);
    assert_int_equal(table_runs_read(path, "simpleA", all, &error), DIG_OK);
    for (size_t r = 0; r < all->runs; r++) {
        const struct dig_gravel *const truth = &all->set->gravel[all->run[r].entry];
        struct dig_observation         dig   = table_run_observed(&all->run[r]);
        struct dig_match               match;
        dig.forces = true;
        dig_pool_sum(1, &dig, &sums);
        assert_int_equal(dig_posterior_fill(table, &sums, &match), DIG_OK);
        tally->digs++;
        for (int a = 0; a < DIG_AXES; a++) {
            const double v = truth->value[a];
            tally->in[a] += v >= match.low.value[a] && v <= match.high.value[a] ? 1 : 0;
            tally->off2[a] += pow(dig_axis_position(table, (enum dig_axis)a, match.mean.value[a]) -
                                      dig_axis_position(table, (enum dig_axis)a, v),
                                  2.0);
        }
    }
    dig_curve_set_destroy(all->set);
    free(all);
}

TEST(the_interval_holds_gravels_that_no_table_has)
{
    struct dig_curve_set *table = NULL;
    struct dig_error      error = { "" };
    struct tally          t     = { 0 };
    int                   in    = 0;
    assert_int_equal(dig_table_load("tables/product.sqlite", &table, &error), DIG_OK);
    tell(table, "tests/data/product/spread/develop.sqlite", &t);
    tell(table, "tests/data/product/spread/judge.sqlite", &t);
    for (int a = 0; a < DIG_AXES; a++) {
        in += t.in[a];
        print_message("axis %d: %d of %d in the interval, off %.3f\n", a, t.in[a], t.digs,
                      sqrt(t.off2[a] / t.digs));
        // Not fewer than three standard errors below nine in ten; better told than by the middle of
        // the axis, which is off by 0.29.
        assert_true(t.in[a] > t.digs * (0.9 - 3.0 * sqrt(0.9 * 0.1 / t.digs)));
        assert_true(t.off2[a] < 0.25 * 0.25 * t.digs);
    }
    assert_int_equal(t.digs, 28);
    assert_true(in >= 0.85 * 3 * t.digs);
    dig_curve_set_destroy(table);
}
