// Tests for estimator/match/fit_nlopt.c and estimator/match/posterior.c

#include "tests/estimator/fitted_match.h"
#include "tests/estimator/random_dig.h"

#include <stdlib.h>
#include <string.h>

static const struct made_options plain = { .relative_sd = 0.1, .packings = 1000 };

// Observations read off the interpolated table itself have a gravel of distance 0, wherever it
// lies.
TEST(a_gravel_planted_between_the_grid_points_is_found)
{
    struct dig_curve_set *const set  = made_table(&plain);
    uint64_t                    seed = 4;
    for (int trial = 0; trial < 30; trial++) {
        const struct dig_gravel planted = random_gravel(&seed);
        struct dig_curve        curve;
        assert_int_equal(dig_match_interpolate(set, &planted, MADE_SIMPLE_A, &curve), DIG_OK);
        struct dig_observation o = made_observation(&planted, MADE_SIMPLE_A, 0.0);
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            o.moment_Nm[k] = (double)curve.mean[DIG_CHANNEL_MY_Nm][k];
        }
        const struct dig_match match = fit(set, 1, &o, 1500);
        assert_true(match.distance <= match.nearest_distance);
        assert_close(match.distance, 0.0, 0.01);

        // Height is (.3 + friction) * density, the hump rolling * density: only ratios are told.
        const double height = (0.3 + planted.value[0]) * planted.value[2];
        const double hump   = planted.value[1] * planted.value[2];
        assert_close((0.3 + match.gravel.value[0]) * match.gravel.value[2] / height, 1.0, 0.06);
        assert_close(match.gravel.value[1] * match.gravel.value[2] / hump, 1.0, 0.15);
    }
    made_table_destroy(set);
}

TEST(with_one_density_friction_and_rolling_are_found_themselves)
{
    const struct made_options   one = { .relative_sd = 0.1, .packings = 1000, .one_density = true };
    struct dig_curve_set *const set = made_table(&one);
    const struct dig_gravel     planted = { { 0.62, 0.33, 2500 } };
    const struct dig_observation o      = made_observation(&planted, MADE_SIMPLE_A, 0.0);
    const struct dig_match       match  = fit(set, 1, &o, 600);
    assert_close(match.gravel.value[0], 0.62, 0.005);
    assert_close(match.gravel.value[1], 0.33, 0.01);
    assert_close(match.gravel.value[2], 2500, 0.0);
    assert_close(match.low.value[2], 2500, 0.0);
    assert_true(match.low.value[0] < 0.62 && match.high.value[0] > 0.62);
    assert_true(match.high.value[0] - match.low.value[0] < 0.3);
    made_table_destroy(set);
}

TEST(more_evaluations_never_make_it_worse_and_few_are_enough_to_return)
{
    struct dig_curve_set *const  set           = made_table(&plain);
    const struct dig_gravel      planted       = { { 0.61, 0.5, 3000 } };
    const struct dig_observation o             = made_observation(&planted, MADE_SIMPLE_A, 0.0);
    const int                    evaluations[] = { 1, 2, 5, 30, 100, 400 };
    for (size_t i = 0; i < sizeof evaluations / sizeof evaluations[0]; i++) {
        const struct dig_match match = fit(set, 1, &o, evaluations[i]);
        assert_true(match.distance <= match.nearest_distance + 1e-12);
        assert_int_equal(match.samples, DIG_MATCH_SAMPLES);
    }
    made_table_destroy(set);
}

TEST(a_hole_is_gone_round)
{
    const struct made_options    holed   = { .relative_sd = 0.1, .packings = 3, .hole = true };
    struct dig_curve_set *const  set     = made_table(&holed);
    const struct dig_gravel      planted = { { 0.52, 0.42, 2600 } }; // beside the hole
    const struct dig_observation o       = made_observation(&planted, MADE_SIMPLE_A, 0.0);
    const struct dig_match       match   = fit(set, 1, &o, 400);
    struct dig_curve             curve;
    assert_int_equal(dig_match_interpolate(set, &match.gravel, MADE_SIMPLE_A, &curve), DIG_OK);
    for (size_t s = 0; s < match.samples; s++) {
        assert_int_equal(dig_match_interpolate(set, &match.sample[s], MADE_SIMPLE_A, &curve),
                         DIG_OK);
    }
    made_table_destroy(set);
}

// Two gravels of one friction + rolling resist alike: the answer must be "anything along here".
TEST(what_cannot_be_told_apart_has_a_wide_interval)
{
    const struct made_options one = { .relative_sd = 0.1, .packings = 1000, .one_density = true };
    const struct made_options family = {
        .family = 1.0, .relative_sd = 0.1, .packings = 1000, .one_density = true
    };
    struct dig_curve_set *const  told    = made_table(&one);
    struct dig_curve_set *const  alike   = made_table(&family);
    const struct dig_gravel      planted = { { 0.6, 0.55, 2500 } };
    const struct dig_observation a       = made_observation(&planted, MADE_ACTUAL, 0.0);
    const struct dig_observation b       = made_observation(&planted, MADE_ACTUAL, 1.0);
    const struct dig_match       sure = fit(told, 1, &a, 300), unsure = fit(alike, 1, &b, 300);
    assert_true(sure.high.value[0] - sure.low.value[0] < 0.3);
    assert_true(unsure.high.value[0] - unsure.low.value[0] > 0.45);
    assert_true(unsure.high.value[1] - unsure.low.value[1] > 0.45);

    // And says by itself which it is: any of a family, or, after several digs, a point. (Of one dig
    // rolling friction is told to within two thirds of its axis: not told.)
    char                   names[DIG_UNTOLD_SIZE];
    struct dig_observation digs[8];
    for (size_t d = 0; d < 8; d++) {
        digs[d] = a;
    }
    const struct dig_match point = fit(told, 8, digs, 300);
    print_message(
        "axis 0, 1: %.2f %.2f of one dig, %.2f %.2f of eight, %.2f %.2f of alike\n",
        sure.high.value[0] - sure.low.value[0], sure.high.value[1] - sure.low.value[1],
        point.high.value[0] - point.low.value[0], point.high.value[1] - point.low.value[1],
        unsure.high.value[0] - unsure.low.value[0], unsure.high.value[1] - unsure.low.value[1]);
    assert_true(point.high.value[0] - point.low.value[0] < 0.2);
    assert_true(point.high.value[1] - point.low.value[1] < 0.3);
    assert_false(dig_match_is_family(&point));
    dig_match_unresolved(&point, names);
    assert_string_equal(names, "");
    assert_true(dig_match_is_family(&unsure));
    dig_match_unresolved(&unsure, names);
    assert_string_equal(names, "friction, rolling");

    // All of them lie along the family, though.
    for (size_t s = 0; s < unsure.samples; s++) {
        assert_close(unsure.sample[s].value[0] + unsure.sample[s].value[1], 1.15, 0.45);
    }
    made_table_destroy(told);
    made_table_destroy(alike);
}

// Gravels drawn from the prior, digs disturbed as the table says: nine of ten lie in the interval.
TEST(ninety_per_cent_of_gravels_lie_in_their_interval)
{
    struct dig_curve_set *const set    = made_table(&plain);
    const int                   trials = test_is_quick() ? 40 : 200;
    uint64_t                    seed   = 99;
    struct held                 held   = { 0 };
    for (int trial = 0; trial < trials; trial++) {
        const struct dig_gravel planted = random_gravel(&seed);
        struct dig_observation  o       = made_observation(&planted, MADE_ACTUAL, 0.0);
        made_disturb(&o, 0.1, &seed);
        const struct dig_match match = fit(set, 1, &o, 30);
        held_add(&held, &match, &planted);
        for (int a = 0; a < DIG_AXES; a++) {
            assert_true(match.low.value[a] <= match.mean.value[a] &&
                        match.mean.value[a] <= match.high.value[a]);
        }
    }
    for (int a = 0; a < DIG_AXES; a++) {
        print_message("axis %d: %d of %d in the 90 %% interval\n", a, held.in[a], trials);
        assert_close((double)held.in[a] / trials, 0.9, trials < 100 ? 0.13 : 0.06);
    }
    made_table_destroy(set);
}

// So do they when only part of a path was dug, in an interval as wide as that leaves it.
TEST(of_part_of_a_path_less_is_told_and_as_rightly)
{
    const struct made_options   one = { .relative_sd = 0.1, .packings = 1000, .one_density = true };
    struct dig_curve_set *const set = made_table(&one);
    const int                   trials  = test_is_quick() ? 60 : 200;
    static const double         until[] = { 1.0, 0.6, 0.3 };
    static const char *const    what[]  = { "the whole path", "0.6 of it", "0.3 of it" };
    uint64_t                    seed    = 7;
    struct held                 held[3] = { { 0 } };
    for (int trial = 0; trial < trials; trial++) {
        struct dig_gravel planted = random_gravel(&seed);
        planted.value[2]          = 2500;
        struct dig_observation o  = made_observation(&planted, MADE_ACTUAL, 0.0);
        made_disturb(&o, 0.1, &seed);
        for (int u = 0; u < 3; u++) {
            o.last                       = until[u];
            const struct dig_match match = fit(set, 1, &o, 100);
            held_add(&held[u], &match, &planted);
        }
    }
    for (int u = 0; u < 3; u++) {
        held_expect(&held[u], 2, what[u]);
    }
    assert_true(held[1].width[0] > held[0].width[0] && held[2].width[0] > 1.2 * held[0].width[0]);
    made_table_destroy(set);
}

TEST(between_the_grid_points_a_dig_is_judged_again)
{
    const struct made_options    quiet   = { .relative_sd = 0.004, .packings = 1000 };
    struct dig_curve_set *const  set     = made_table(&quiet);
    const struct dig_gravel      planted = { { 0.6, 0.55, 2500 } };
    const struct dig_observation o       = made_observation(&planted, MADE_SIMPLE_A, 0.0);
    struct dig_match             match;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_true(match.outside);
    assert_int_equal(dig_fit_refine(set, 1, &o, 2000, &match), DIG_OK);
    assert_false(match.outside);
    made_table_destroy(set);
}

// Entries without a grid behind them: the nearest stands, and nothing is claimed about it.
TEST(scattered_entries_keep_their_nearest)
{
    struct dig_curve_set *const  set = made_table(&plain);
    const struct dig_observation o   = made_observation(&set->gravel[9], MADE_SIMPLE_A, 0.0);
    for (int a = 0; a < DIG_AXES; a++) {
        set->axis_count[a] = 0;
    }
    const struct dig_match match = fit(set, 1, &o, 100);
    assert_int_equal(match.nearest, 9);
    assert_int_equal(match.samples, 0);
    assert_close(match.gravel.value[0], set->gravel[9].value[0], 0.0);
    made_table_destroy(set);
}

TEST(refusals_leave_the_match_alone)
{
    struct dig_curve_set *const set = made_table(&plain);
    struct dig_observation      o   = made_observation(&set->gravel[9], MADE_SIMPLE_A, 0.0);
    struct dig_match            match;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    struct dig_match before;
    memcpy(&before, &match, sizeof before);
    assert_int_equal(dig_fit_refine(set, 1, &o, 0, &match), DIG_EINVAL);
    o.moment_Nm[4] = NAN;
    assert_int_equal(dig_fit_refine(set, 1, &o, 100, &match), DIG_EINVAL);
    o.moment_Nm[4] = 0.0;
    assert_memory_equal(&match, &before, sizeof match);
    match.valid = false;
    assert_int_equal(dig_fit_refine(set, 1, &o, 100, &match), DIG_EINVAL);
    match.valid   = true;
    match.nearest = (int)set->entries;
    assert_int_equal(dig_fit_refine(set, 1, &o, 100, &match), DIG_EINVAL);
    made_table_destroy(set);
}
