// Tests for estimator/match/depth.c and estimator/approach/laid.c.

#include "estimator/match/depth.h"

#include "estimator/approach/approach_route.h"
#include "estimator/approach/approached.h"
#include "estimator/approach/laid.h"
#include "estimator/match/entry_scatter.h"
#include "estimator/match/likelihood.h"
#include "tests/testlib.h"

#include "tests/approach_table.h"

#include <stdlib.h>

static const struct dig_approach cross[] = {
    { 0.8, 0.0 }, { 1.0, -0.1 }, { 1.0, 0.1 }, { 1.2, 0.0 }
};

static const double scatter = 0.07;
static const double over    = 1.8; // depth over whose path digs are observed

static struct approach_table table;

static int set_up(void **state)
{
    (void)state;
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, scatter, 3);
    return 0;
}

// The dig at one depth over the path at another, by lengths behind the corner; error in standard
// deviations, point by point of its own path, or NULL.
static struct dig_observation observe(const size_t gravel, const double depth,
                                      const double over_depth, const double error[])
{
    const struct dig_trajectory dug   = approach_dug(0, (struct dig_approach){ depth, 0.0 });
    const struct dig_trajectory path  = approach_dug(0, (struct dig_approach){ over_depth, 0.0 });
    const double                own_m = dig_trajectory_path_m(&dug, 0.09, 1e3);
    const double                all_m = dig_trajectory_path_m(&path, 0.09, 1e3);
    struct dig_observation      dig   = {
               .dig_count = 1, .approach = { over_depth, 0.0 }, .made = { 1.0, 0.0 }, .last = 1.0
    };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_m     = all_m * (double)k / (DIG_CURVE_POINTS - 1) - (all_m - own_m);
        const double progress = at_m / own_m;
        dig.sigma_Nm[k]       = 0.002;
        if (progress >= 0.0) {
            const double t_s    = dig_trajectory_time_s(&dug, 0.09, progress);
            const double factor = approach_growing(depth, 0.0);
            const size_t at     = (size_t)(progress * (DIG_CURVE_POINTS - 1));
            const double off    = error != NULL ? error[at] : 0.0;
            dig.moment_Nm[k]    = approach_moment_Nm(gravel, 0, t_s, factor) +
                               0.7 * off * scatter * factor * approach_strength(gravel);
        }
    }
    return dig;
}

static enum dig_status fit(const double limit_m, struct dig_observation *const dig)
{
    const struct dig_curve_set *const set    = &table.cube.set;
    void *const                       memory = malloc(dig_depth_fit_size(set));
    struct dig_approach_error         error[2];
    dig_approach_error_measure(set, 0, &error[0]);
    dig_approach_error_measure(set, 1, &error[1]);
    const enum dig_status status = dig_depth_fit(set, error, limit_m, memory, dig);
    free(memory);
    return status;
}

TEST_WITH(a_dig_laid_over_another_path_stays_where_it_was, set_up, NULL)
{
    static const double to[] = { 0.8, 1.0, 1.15 };
    for (size_t i = 0; i < sizeof to / sizeof to[0]; i++) {
        struct dig_observation       dig  = observe(5, 1.0, over, NULL);
        const struct dig_observation same = observe(5, 1.0, to[i], NULL);
        dig_laid_observation(&table.cube.set, to[i], &dig);
        assert_close(dig.approach.depth, to[i], 0.0);
        assert_close(dig.first, 0.0, 0.0);
        assert_close(dig.last, 1.0, 1e-12);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            assert_close(dig.moment_Nm[k], same.moment_Nm[k], 0.02);
            assert_close(dig.sigma_Nm[k], 0.002, 1e-9);
        }
    }
}

// Over a longer path it begins later; over a shorter one, what was not measured stays so.
TEST_WITH(what_was_not_measured_is_not_made_up, set_up, NULL)
{
    const double           whole_m[] = { 0.0301800 + 0.1292, 1.2 * 0.0301800 + 0.1292 };
    struct dig_observation dig       = observe(2, 1.0, 1.0, NULL);
    dig_laid_observation(&table.cube.set, 1.2, &dig);
    assert_close(dig.first, 0.2 * 0.0301800 / whole_m[1], 1e-4);
    assert_close(dig.moment_Nm[4], 0.0, 0.0);
    assert_close(dig.sigma_Nm[4], 0.0, 0.0);
    assert_true(dig.sigma_Nm[12] > 0.0);
    dig       = observe(2, 1.0, 1.2, NULL);
    dig.first = 0.5;
    dig.last  = 0.9;
    dig_laid_observation(&table.cube.set, 1.0, &dig);
    assert_close((1.0 - dig.first) * whole_m[0], 0.5 * whole_m[1], 1e-5);
    assert_close((1.0 - dig.last) * whole_m[0], 0.1 * whole_m[1], 1e-5);
}

// In the air nothing resists: a table's curve is 0 before its own start.
TEST_WITH(a_curve_over_a_deeper_path_begins_later, set_up, NULL)
{
    static struct dig_curve curve;
    double                  place[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        curve.mean[DIG_CHANNEL_MY_Nm][k] = 1.0F;
    }
    dig_laid_places(&table.cube.set, 0, 1.2, 1.0, place);
    dig_laid_curve(place, &curve);
    // A fifth of the first leg, of 165.4 mm in all: 9.3 of 255 steps.
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close((double)curve.mean[DIG_CHANNEL_MY_Nm][k], k <= 9 ? 0.0 : 1.0, 1e-6);
    }
}

// The depth of the greatest evidence, by 81 tables.
static double likeliest(const struct dig_observation *const dig)
{
    const struct dig_curve_set *const set    = &table.cube.set;
    void *const                       memory = malloc(dig_depth_fit_size(set));
    struct dig_approach_error         error[2];
    struct dig_pool_sums              sums;
    double                            best = 0.0;
    double                            most = -INFINITY;
    dig_approach_error_measure(set, 0, &error[0]);
    dig_pool_sum(1, dig, &sums);
    for (int i = 0; i <= 80; i++) {
        const struct dig_approached_slot slot     = { 0, { 0.8 + 0.005 * i, 0.0 }, over, NULL };
        const double                     evidence = dig_likelihood_evidence(
                                dig_approached_make(set, 1, &slot, error, memory), &sums.group[0]);
        best = evidence > most ? 0.8 + 0.005 * i : best;
        most = fmax(most, evidence);
    }
    free(memory);
    return best;
}

// Nine looks, .05 apart here, find what many do, to half a step.
TEST_WITH(the_likeliest_depth_is_found_by_few_looks, set_up, NULL)
{
    static const double depth[] = { 0.875, 0.93, 1.07, 1.12 };
    for (size_t i = 0; i < sizeof depth / sizeof depth[0]; i += test_is_quick() ? 3 : 1) {
        struct dig_observation dig  = observe(5, depth[i], over, NULL);
        const double           best = likeliest(&dig);
        assert_int_equal(fit(0.008, &dig), DIG_OK);
        print_message("depth %.3f: told %.4f, likeliest %.3f\n", depth[i], dig.made.depth, best);
        assert_close(dig.made.depth, best, 0.025);
    }
}

// Digs that scatter as the table says; where the soil begins to resist tells less.
TEST_WITH(depth_is_told_by_all_of_a_dig, set_up, NULL)
{
    static const double      depth[] = { 0.85, 1.0, 1.15 };
    const size_t             digs    = test_is_quick() ? 8 : 24;
    struct dig_entry_scatter shape;
    uint64_t                 seed = 5;
    for (size_t i = 0; i < sizeof depth / sizeof depth[0]; i++) {
        const struct dig_trajectory dug  = approach_dug(0, (struct dig_approach){ depth[i], 0.0 });
        double                      off  = 0.0;
        double                      off2 = 0.0;
        double                      rough2 = 0.0;
        dig_entry_scatter_make(&dug, 0.09, &shape);
        for (size_t d = 0; d < digs; d++) {
            double error[DIG_CURVE_POINTS];
            dig_entry_scatter_draw(&shape, &seed, error);
            struct dig_observation dig = observe(d % CUBE_GRAVELS, depth[i], over, error);
            const double           rough =
                dig_approach_depth(&table.cube.set, 0, over, 0.0, 0.0, 1.0, dig.moment_Nm);
            assert_int_equal(fit(0.008, &dig), DIG_OK);
            assert_true(dig_approach_is_same(&dig.made, &dig.approach));
            off += (dig.made.depth - depth[i]) / (double)digs;
            off2 += pow(dig.made.depth - depth[i], 2.0) / (double)digs;
            rough2 += pow(rough - depth[i], 2.0) / (double)digs;
        }
        print_message("depth %.2f: off by %.3f, rms %.3f; by where it begins %.3f\n", depth[i], off,
                      sqrt(off2), sqrt(rough2));
        assert_true(test_is_quick() || fabs(off) < 0.02);
        assert_true(sqrt(off2) < 0.7 * sqrt(rough2));
    }
}

// The rough depth of a dig counts only beyond the end at which all of the curve puts it.
TEST_WITH(what_seems_to_lie_beyond_the_table_is_distance, set_up, NULL)
{
    struct dig_observation dig = observe(3, 1.0, over, NULL);
    dig.made.depth             = 0.3; // the first grain lay low
    assert_int_equal(fit(0.008, &dig), DIG_OK);
    assert_close(dig.made.depth, 1.0, 0.02);

    dig            = observe(3, 1.35, over, NULL);
    dig.made.depth = 1.35;
    assert_int_equal(fit(0.008, &dig), DIG_OK);
    assert_close(dig.made.depth, 1.35, 0.0);
    assert_close(dig.approach.depth, 1.2, 1e-9);
    assert_close(dig.off_path_m, 0.15 * APPROACH_m, 1e-9);

    dig            = observe(3, 1.35, over, NULL);
    dig.made.depth = 1.35;
    assert_int_equal(fit(0.003, &dig), DIG_ENOMATCH);
    assert_close(dig.approach.depth, over, 0.0); // as it was
}

TEST_WITH(a_table_of_one_depth_tells_none, set_up, NULL)
{
    table.cube.set.approaches  = NULL;
    struct dig_observation dig = observe(3, 1.0, 1.0, NULL);
    dig.made                   = (struct dig_approach){ .depth = 0.0 };
    assert_int_equal(fit(0.008, &dig), DIG_OK);
    assert_close(dig.made.depth, 0.0, 0.0);
    dig.moment_Nm[9] = (double)NAN;
    assert_int_equal(fit(0.008, &dig), DIG_EINVAL);
}
