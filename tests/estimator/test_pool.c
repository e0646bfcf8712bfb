// Tests for estimator/match/pool.c, and for what several digs do to distance and posterior

#include "estimator/match/pool.h"

#include "tests/estimator/fitted_match.h"
#include "tests/estimator/random_dig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PACKINGS = 3 };
static const double               scatter = 0.1;
static const struct made_options  few     = { .relative_sd = 0.1, .packings = PACKINGS };
static const struct made_options  flat    = { .relative_sd = 0.1,
                                              .packings    = PACKINGS,
                                              .one_density = true };
static const enum made_trajectory both[]  = { MADE_SIMPLE_A, MADE_SIMPLE_B };

// What the table's mean of few packings is wrong by is the same for all digs of a trajectory; each
// adds its own.
static void dig_there(const struct dig_gravel *const gravel, const enum made_trajectory along,
                      const size_t digs, struct dig_observation dig[], uint64_t *const seed)
{
    struct dig_observation true_mean = made_observation(gravel, along, 0.0);
    made_disturb(&true_mean, scatter / sqrt(PACKINGS), seed);
    for (size_t d = 0; d < digs; d++) {
        dig[d]           = true_mean;
        dig[d].dig_count = (uint32_t)d + 1;
        made_disturb(&dig[d], scatter, seed);
    }
}

TEST(each_channel_is_summed_where_it_was_measured)
{
    static struct dig_pool_sums sums;
    static const double         value[2][3] = { { 1.0, 2.0, 3.0 }, { 5.0, 8.0, 13.0 } };
    struct dig_observation      dig[2]      = { { .last = 1.0 }, { .first = 0.5, .last = 1.0 } };
    for (int d = 0; d < 2; d++) {
        dig[d].forces = true;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            dig[d].moment_Nm[k] = dig[d].sigma_Nm[k] = value[d][0];
            for (int c = 0; c < 2; c++) {
                dig[d].force_N[c][k] = dig[d].force_sigma_N[c][k] = value[d][1 + c];
            }
        }
    }
    dig_pool_sum(2, dig, &sums);
    assert_int_equal(sums.groups, 1);
    for (int c = 0; c < 3; c++) {
        const double a = value[0][c], b = value[1][c];
        assert_close(sums.group[0].mean[c][0], a, 1e-12);
        assert_close(sums.group[0].sigma2[c][0], a * a, 1e-12);
        assert_close(sums.group[0].mean[c][255], 0.5 * (a + b), 1e-12);
        assert_close(sums.group[0].sigma2[c][255], 0.5 * (a * a + b * b), 1e-12);
    }
    assert_close(sums.group[0].scatter_Nm2, 128.0 * 8.0, 1e-9);
    assert_close(sums.group[0].norm2_Nm2, 256.0 + 128.0 * 25.0, 1e-9);
}

TEST(the_oldest_leaves_a_full_pool)
{
    static struct dig_pool       pool;
    const struct dig_gravel      gravel = { { 0.5, 0.5, 2500 } };
    const struct dig_observation one    = made_observation(&gravel, MADE_SIMPLE_A, 0.0);
    for (unsigned i = 1; i <= DIG_POOL_MAX + 3; i++) {
        struct dig_observation dig = one;
        dig.dig_count              = i;
        dig_pool_add(&pool, &dig);
        assert_int_equal(pool.digs, i < DIG_POOL_MAX ? i : DIG_POOL_MAX);
        assert_int_equal(pool.dig[pool.digs - 1].dig_count, i);
    }
    assert_int_equal(pool.dig[0].dig_count, 4);
}

// The test's own sums: two trajectories, other ranges, sigmas of their own.
TEST(sums_are_what_brute_force_adds_up)
{
    enum { DIGS = 5 };
    struct dig_curve_set *const set  = made_table(&few);
    uint64_t                    seed = 5;
    struct dig_observation      dig[DIGS];
    for (int d = 0; d < DIGS; d++) {
        const struct dig_gravel gravel = random_gravel_of(&seed, 2200);
        dig[d]                         = made_observation(&gravel, both[d % 2], 0.0);
        made_disturb(&dig[d], 0.2, &seed);
        dig[d].first = 0.1 * d;
        dig[d].last  = d == 3 ? 0.5 : 1.0;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            dig[d].sigma_Nm[k] = 0.01 * (1 + d) * k;
        }
    }
    size_t best  = 0;
    double least = INFINITY, floor_at_best = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        double miss2 = 0.0, whole2 = 0.0, floor2 = 0.0;
        for (int d = 0; d < DIGS; d++) {
            const struct dig_curve *const c =
                &set->curve[e * MADE_TRAJECTORIES + (size_t)dig[d].trajectory];
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                if (k / 255.0 >= dig[d].first && k / 255.0 <= dig[d].last) {
                    miss2 += pow(dig[d].moment_Nm[k] - (double)c->mean[0][k], 2.0);
                    whole2 += pow(dig[d].moment_Nm[k], 2.0);
                    floor2 += pow((double)c->sd[0][k], 2.0) * (1.0 + 1.0 / PACKINGS) +
                              pow(dig[d].sigma_Nm[k], 2.0);
                }
            }
        }
        if (sqrt(miss2 / whole2) < least) {
            least         = sqrt(miss2 / whole2);
            floor_at_best = sqrt(floor2 / whole2);
            best          = e;
        }
    }
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, DIGS, dig, 2.5, &match), DIG_OK);
    assert_int_equal(match.nearest, (int)best);
    assert_close(match.nearest_distance, least, 1e-12);
    assert_close(match.noise_floor, floor_at_best, 1e-12);
    made_table_destroy(set);
}

TEST(a_gravel_without_one_of_the_trajectories_is_passed_over)
{
    struct dig_curve_set *const  set    = made_table(&few);
    const struct dig_observation dig[2] = { made_observation(&set->gravel[5], MADE_SIMPLE_A, 0.0),
                                            made_observation(&set->gravel[5], MADE_SIMPLE_B, 0.0) };
    struct dig_match             match;
    assert_int_equal(dig_match_nearest(set, 2, dig, 2.5, &match), DIG_OK);
    assert_int_equal(match.nearest, 5);
    set->packings[5 * MADE_TRAJECTORIES + MADE_SIMPLE_B] = 0;
    assert_int_equal(dig_match_nearest(set, 2, dig, 2.5, &match), DIG_OK);
    assert_int_not_equal(match.nearest, 5);
    made_table_destroy(set);
}

// Nine of ten gravels lie in their interval however many digs it comes from, and it narrows as the
// digs' own scatter does: to what the table is wrong by, not to nothing.
TEST(more_digs_tell_more_and_never_too_much)
{
    static const size_t digs[] = { 1, 2, 4, 8 };
    enum { STEPS = sizeof digs / sizeof digs[0] };
    struct dig_curve_set *const set         = made_table(&flat);
    const int                   trials      = test_is_quick() ? 60 : 300;
    uint64_t                    seed        = 2026;
    struct held                 held[STEPS] = { { 0 } };
    for (int trial = 0; trial < trials; trial++) {
        const struct dig_gravel gravel = random_gravel_of(&seed, 2500);
        struct dig_observation  dig[DIG_POOL_MAX];
        dig_there(&gravel, MADE_ACTUAL, DIG_POOL_MAX, dig, &seed);
        for (int s = 0; s < STEPS; s++) {
            const struct dig_match m = fit(set, digs[s], dig, 100);
            held_add(&held[s], &m, &gravel);
        }
    }
    for (int s = 0; s < STEPS; s++) {
        char what[32];
        (void)snprintf(what, sizeof what, "%zu digs", digs[s]);
        held_expect(&held[s], 2, what);
        assert_true(s == 0 || (held[s].width[0] < held[s - 1].width[0] &&
                               held[s].width[1] < held[s - 1].width[1]));
    }
    // Errors of 1/n + 1/3 parts of one dig's variance: of eight digs 0.59 of those of one.
    const double narrower = held[3].width[0] / held[0].width[0];
    assert_true(narrower > 0.50 && narrower < 0.70);
    made_table_destroy(set);
}

// The same digs in another order, and along two trajectories, say the same or more.
TEST(trajectories_add_up)
{
    struct dig_curve_set *const set    = made_table(&flat);
    uint64_t                    seed   = 11;
    const struct dig_gravel     gravel = { { 0.62, 0.4, 2500 } };
    struct dig_observation      dig[4];
    dig_there(&gravel, MADE_SIMPLE_A, 2, &dig[0], &seed);
    dig_there(&gravel, MADE_SIMPLE_B, 2, &dig[2], &seed);
    const struct dig_observation mixed[4] = { dig[2], dig[0], dig[3], dig[1] };
    const struct dig_match       a = fit(set, 2, dig, 1), b = fit(set, 2, &dig[2], 1);
    const struct dig_match       all = fit(set, 4, dig, 1), other = fit(set, 4, mixed, 1);
    for (int axis = 0; axis < 2; axis++) {
        const double width = all.high.value[axis] - all.low.value[axis];
        assert_true(width < a.high.value[axis] - a.low.value[axis]);
        assert_true(width < b.high.value[axis] - b.low.value[axis]);
        assert_close(other.low.value[axis], all.low.value[axis], 1e-6);
        assert_close(other.high.value[axis], all.high.value[axis], 1e-6);
    }
    made_table_destroy(set);
}

// Who has more digs than a pool keeps may match them all.
TEST(twice_the_digs_of_a_pool_add_up)
{
    enum { MANY = 2 * DIG_POOL_MAX };
    struct dig_curve_set *const set    = made_table(&flat);
    uint64_t                    seed   = 5;
    const struct dig_gravel     gravel = { { 0.62, 0.4, 2500 } };
    struct dig_observation      dig[MANY];
    dig_there(&gravel, MADE_SIMPLE_A, MANY, dig, &seed);
    const struct dig_match half = fit(set, DIG_POOL_MAX, dig, 1), all = fit(set, MANY, dig, 1);
    assert_int_equal(all.dig_count, MANY);
    assert_true(all.high.value[0] - all.low.value[0] < half.high.value[0] - half.low.value[0]);
    made_table_destroy(set);
}

TEST(refusals_write_nothing)
{
    struct dig_curve_set *const set = made_table(&flat);
    struct dig_observation      dig[3];
    for (int d = 0; d < 3; d++) {
        dig[d] = made_observation(&set->gravel[3], MADE_SIMPLE_A, 0.0);
    }
    struct dig_match match = { .nearest = 42 };
    assert_int_equal(dig_match_nearest(set, 0, dig, 2.5, &match), DIG_EINVAL);
    dig[2].moment_Nm[9] = NAN;
    assert_int_equal(dig_match_nearest(set, 3, dig, 2.5, &match), DIG_EINVAL);
    assert_int_equal(match.nearest, 42);

    assert_int_equal(dig_match_nearest(set, 2, dig, 2.5, &match), DIG_OK);
    struct dig_match before;
    memcpy(&before, &match, sizeof before);
    assert_int_equal(dig_fit_refine(set, 0, dig, 10, &match), DIG_EINVAL);
    assert_int_equal(dig_fit_refine(set, 3, dig, 10, &match), DIG_EINVAL);
    assert_memory_equal(&match, &before, sizeof match);
    made_table_destroy(set);
}
