// Tests for estimator/match/match.c and estimator/approach/interpolate.c

#include "estimator/match/match.h"

#include "estimator/approach/interpolate.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

#include <string.h>

static const struct made_options plain = { .relative_sd = 0.15, .packings = 3 };

// The test's own norm, in one breath, without cells or weights.
static double distance_to(const struct dig_curve_set *const set, const size_t entry,
                          const struct dig_observation *const o)
{
    const struct dig_curve *const curve =
        &set->curve[entry * set->trajectories + (size_t)o->trajectory];
    double miss = 0.0, whole = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        if (k / 255.0 >= o->first && k / 255.0 <= o->last) {
            miss += pow(o->moment_Nm[k] - (double)curve->mean[DIG_CHANNEL_MY_Nm][k], 2.0);
            whole += pow(o->moment_Nm[k], 2.0);
        }
    }
    return sqrt(miss / whole);
}

TEST(nearest_is_what_brute_force_finds)
{
    struct dig_curve_set *const set  = made_table(&plain);
    uint64_t                    seed = 21;
    for (int trial = 0; trial < 200; trial++) {
        const struct dig_gravel gravel = random_gravel(&seed);
        struct dig_observation  o =
            made_observation(&gravel, (enum made_trajectory)(trial % 3), 0.0);
        made_disturb(&o, 0.2, &seed);
        o.first = trial % 4 == 0 ? 0.3 : 0.0;
        o.last  = trial % 5 == 0 ? 0.6 : 1.0;

        size_t best = 0;
        for (size_t e = 1; e < set->entries; e++) {
            best = distance_to(set, e, &o) < distance_to(set, best, &o) ? e : best;
        }
        struct dig_match match;
        assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
        assert_true(match.valid);
        assert_int_equal(match.nearest, (int)best);
        assert_close(match.nearest_distance, distance_to(set, best, &o), 1e-12);
        assert_close(match.gravel.value[0], set->gravel[best].value[0], 0.0);
    }
    made_table_destroy(set);
}

TEST(an_entry_without_the_trajectory_is_passed_over)
{
    struct dig_curve_set *const  set = made_table(&plain);
    const struct dig_observation o   = made_observation(&set->gravel[5], MADE_ACTUAL, 0.0);
    struct dig_match             match;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_int_equal(match.nearest, 5);
    set->packings[5 * MADE_TRAJECTORIES + MADE_ACTUAL] = 0;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_int_not_equal(match.nearest, 5);

    for (size_t e = 0; e < set->entries; e++) {
        set->packings[e * MADE_TRAJECTORIES + MADE_ACTUAL] = 0;
    }
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_ENOMATCH);
    made_table_destroy(set);
}

// 15 % of spread about a mean of three packings, and a measurement's 10 %, in quadrature.
TEST(the_noise_floor_is_one_dig_about_a_mean_of_few)
{
    struct dig_curve_set *const set = made_table(&plain);
    struct dig_observation      o   = made_observation(&set->gravel[17], MADE_SIMPLE_A, 0.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        o.sigma_Nm[k] = 0.1 * o.moment_Nm[k];
    }
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_close(match.noise_floor, sqrt(0.15 * 0.15 * 4.0 / 3.0 + 0.01), 1e-6);
    made_table_destroy(set);
}

TEST(a_dig_far_from_every_gravel_is_outside)
{
    struct dig_curve_set *const set = made_table(&plain);
    struct dig_observation      o   = made_observation(&set->gravel[47], MADE_SIMPLE_A, 0.0);
    struct dig_match            match;
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_false(match.outside);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        o.moment_Nm[k] *= 2.5; // heavier than the heaviest
    }
    assert_int_equal(dig_match_nearest(set, 1, &o, 2.5, &match), DIG_OK);
    assert_true(match.valid && match.outside);
    made_table_destroy(set);
}

TEST(interpolation_meets_the_entries_and_their_products_between)
{
    struct dig_curve_set *const set = made_table(&plain);
    struct dig_curve            curve;
    for (size_t e = 0; e < set->entries; e++) {
        assert_int_equal(dig_match_interpolate(set, &set->gravel[e], MADE_ACTUAL, &curve), DIG_OK);
        for (int k = 0; k < DIG_CURVE_POINTS; k += 17) {
            assert_close((double)curve.mean[1][k],
                         (double)set->curve[e * 3 + MADE_ACTUAL].mean[1][k], 1e-5);
        }
    }

    // The family is linear in friction and rolling; density enters at the middle of its logarithm.
    const struct dig_gravel between = { { 0.56, 0.25, sqrt(1500.0 * 2500.0) } };
    const struct dig_gravel light = { { 0.56, 0.25, 1500 } }, heavy = { { 0.56, 0.25, 2500 } };
    struct dig_cell         cell;
    double                  mean[DIG_CURVE_POINTS], sd[DIG_CURVE_POINTS];
    assert_int_equal(dig_match_interpolate(set, &between, MADE_ACTUAL, &curve), DIG_OK);
    assert_int_equal(dig_cell_find(set, &between, MADE_ACTUAL, &cell), DIG_OK);
    dig_cell_blend(&cell, DIG_CHANNEL_MY_Nm, mean, sd);
    for (int k = 0; k < DIG_CURVE_POINTS; k += 17) {
        assert_close(mean[k], dig_cell_mean(&cell, DIG_CHANNEL_MY_Nm, (size_t)k), 0.0);
        assert_close(sd[k], dig_cell_sd(&cell, DIG_CHANNEL_MY_Nm, (size_t)k), 0.0);
        const double expected = 0.5 * (made_moment_Nm(&light, MADE_ACTUAL, k / 255.0, 0.0) +
                                       made_moment_Nm(&heavy, MADE_ACTUAL, k / 255.0, 0.0));
        assert_close((double)curve.mean[0][k], expected, 1e-5);
        assert_close((double)curve.sd[0][k], 0.15 * expected, 1e-5);
    }
    made_table_destroy(set);
}

TEST(outside_the_grid_and_beside_a_hole_nothing_is_interpolated)
{
    const struct made_options   holed = { .relative_sd = 0.15, .packings = 3, .hole = true };
    struct dig_curve_set *const set   = made_table(&holed);
    const struct dig_gravel     bad[] = {
            { { 0.29, 0.5, 2500 } }, { { 0.5, 1.01, 2500 } }, { { 0.5, 0.5, 1400 } },
            { { NAN, 0.5, 2500 } },  { { 0.5, 0.4, 2500 } },  { { 0.55, 0.45, 2600 } },
            { { 0.5, 0.5, -1 } },    { { 0.4, 0.35, 2400 } },
    };
    struct dig_curve curve, before;
    memset(&curve, 0x5a, sizeof curve);
    memcpy(&before, &curve, sizeof before);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(dig_match_interpolate(set, &bad[i], 0, &curve), DIG_ENOMATCH);
    }
    assert_int_equal(dig_match_interpolate(set, &set->gravel[0], 3, &curve), DIG_EINVAL);
    assert_memory_equal(&curve, &before, sizeof curve);

    // On a face away from the hole its weight is nothing, and so it does not matter.
    const struct dig_gravel face = { { 0.7, 0.45, 2600 } };
    assert_int_equal(dig_match_interpolate(set, &face, 0, &curve), DIG_OK);
    made_table_destroy(set);
}

TEST(an_observation_that_is_none_is_refused_and_writes_nothing)
{
    struct dig_curve_set *const  set  = made_table(&plain);
    const struct dig_observation good = made_observation(&set->gravel[3], MADE_SIMPLE_A, 0.0);
    struct dig_observation       bad[8];
    for (int i = 0; i < 8; i++) {
        bad[i] = good;
    }
    bad[0].trajectory     = -1;
    bad[1].trajectory     = 3;
    bad[2].moment_Nm[100] = NAN;
    bad[3].moment_Nm[100] = INFINITY;
    bad[4].sigma_Nm[0]    = -1.0;
    bad[5].first          = NAN;
    bad[6].last           = 1.5;
    bad[7].first = 0.9, bad[7].last = 0.8;
    struct dig_match match = { .nearest = 42 };
    for (int i = 0; i < 8; i++) {
        assert_int_equal(dig_match_nearest(set, 1, &bad[i], 2.5, &match), DIG_EINVAL);
    }
    memset(bad[0].moment_Nm, 0, sizeof bad[0].moment_Nm);
    bad[0].trajectory = 0;
    assert_int_equal(dig_match_nearest(set, 1, &bad[0], 2.5, &match), DIG_EINVAL);
    assert_int_equal(dig_match_nearest(set, 1, &good, NAN, &match), DIG_EINVAL);
    assert_int_equal(match.nearest, 42);
    assert_false(match.valid);
    made_table_destroy(set);
}

// An axis is told while its interval takes no more than half of it: 0.3 to 0.9, 0.1 to 1, and
// density by its logarithm.
TEST(an_axis_is_told_by_the_width_of_its_interval)
{
    struct dig_curve_set *const set   = made_table(&(struct made_options){ .packings = 3 });
    struct dig_match            match = { .valid = true, .samples = 32 };
    const double                first = set->axis[DIG_AXIS_DENSITY_kgpm3][0];
    const double                last =
        set->axis[DIG_AXIS_DENSITY_kgpm3][set->axis_count[DIG_AXIS_DENSITY_kgpm3] - 1];
    char names[DIG_UNTOLD_SIZE];
    for (int a = 0; a < DIG_AXES; a++) {
        match.low.value[a]  = set->axis[a][0];
        match.high.value[a] = set->axis[a][set->axis_count[a] - 1];
    }
    dig_match_find_family(set, &match);
    dig_match_unresolved(&match, names);
    assert_true(dig_match_is_family(&match));
    assert_string_equal(names, "friction, rolling, density_kgpm3");

    match.high.value[DIG_AXIS_FRICTION]      = 0.59;
    match.low.value[DIG_AXIS_ROLLING]        = 0.56;
    match.high.value[DIG_AXIS_DENSITY_kgpm3] = sqrt(first * last) * 1.01;
    dig_match_find_family(set, &match);
    dig_match_unresolved(&match, names);
    assert_string_equal(names, "density_kgpm3");
    match.high.value[DIG_AXIS_DENSITY_kgpm3] = sqrt(first * last) * 0.99;
    dig_match_find_family(set, &match);
    assert_false(dig_match_is_family(&match));

    // A match that was not refined has no interval, and says nothing of it.
    match.high.value[DIG_AXIS_FRICTION] = 0.9;
    match.samples                       = 0;
    dig_match_find_family(set, &match);
    assert_false(dig_match_is_family(&match));
    made_table_destroy(set);
}
