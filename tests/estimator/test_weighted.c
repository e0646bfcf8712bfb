// Tests for estimator/match/weighted.c: the formula written out, and what it finds that the
// Euclidean norm of the moment does not

#include "estimator/match/match.h"

#include "core/outline.h"
#include "tests/estimator/random_dig.h"
#include "tests/estimator/weighted_by_hand.h"
#include "tests/testlib.h"

#include <stdlib.h>

static const struct made_options options = { .relative_sd = 0.15, .packings = PACKINGS };

// Of packings: of errors that are sums of a common one and of neighbours', at 200 degrees of
// freedom.
static struct dig_covariance *learnt(uint64_t *const seed)
{
    enum { DIGS = 200, N = DIG_COVARIANCE_NUMBERS };
    struct dig_covariance *const c = calloc(MADE_TRAJECTORIES, sizeof *c);
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        c[t].freedom = DIGS;
        for (int dig = 0; dig < DIGS; dig++) {
            const double shared = 0.1 * model_normal(seed);
            double       error[N], last = 0.0;
            for (int i = 0; i < N; i++) {
                last     = 0.5 * last + (0.05 + 0.01 * (i % 5)) * model_normal(seed);
                error[i] = last + (i / BLOCKS == 1 ? -shared : shared);
            }
            for (int i = 0; i < N; i++) {
                for (int j = 0; j < N; j++) {
                    c[t].of[i][j] += error[i] * error[j] / DIGS;
                }
            }
        }
    }
    return c;
}

// Friction of drives that turn about at some point, and act on channels in their own way.
static void rub(struct dig_observation *const o, uint64_t *const seed)
{
    for (int j = 0; j < DIG_RUBS; j++) {
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const double by = (c == 0 ? 0.1 : 0.5) * model_normal(seed);
            for (int k = 0; k < POINTS; k++) {
                double *const sigma = c == 0 ? &o->sigma_Nm[k] : &o->force_sigma_N[c - 1][k];
                o->rubs[j][c][k]    = (float)(k < 60 + 50 * j ? by : -by);
                *sigma              = hypot(*sigma, by);
            }
        }
    }
}

TEST(it_is_the_formula_written_out)
{
    struct dig_curve_set *const set                       = made_table(&options);
    uint64_t                    seed                      = 17;
    int                         found                     = 0;
    set->packings[11 * MADE_TRAJECTORIES + MADE_SIMPLE_A] = 0; // a hole
    dig_outlines_draw(set);
    for (int trial = 0; trial < 24; trial++) {
        if (trial == 12) {
            set->covariance = learnt(&seed);
        }
        const struct dig_gravel gravel = trial % 3 == 0 ? set->gravel[11] : random_gravel(&seed);
        struct dig_observation  dig[3];
        const size_t            digs = 1 + (size_t)trial % 3;
        for (size_t d = 0; d < digs; d++) {
            dig[d]       = make_dig(&gravel, (enum made_trajectory)((d + (size_t)trial) % 2),
                                    trial % 4 < 2, &seed);
            dig[d].first = trial % 5 == 0 ? 0.1 + 0.1 * (double)d : 0.0;
            dig[d].last  = trial % 7 == 0 ? 0.6 : 1.0;
            if (trial % 4 > 0) {
                rub(&dig[d], &seed);
            }
        }
        struct dig_pool_sums sums;
        dig_pool_sum(digs, dig, &sums);
        const size_t                  nearest  = 12 + (size_t)trial;
        const struct weighted_by_hand expected = by_hand(set, &sums, 0.15, nearest);
        struct dig_match              match    = { .valid = true, .nearest = (int)nearest };
        dig_match_find_weighted(set, digs, dig, &match);
        assert_int_equal(match.weighted, expected.entry);
        assert_close(match.weighted_distance, expected.distance, 1e-6 * expected.distance);
        assert_int_equal(match.nearest, nearest);
        found += match.weighted >= 0 ? 1 : 0;
    }
    assert_int_equal(found, 24);
    free(set->covariance);
    set->covariance = NULL;
    made_table_destroy(set);
}

// Moments that are alike, pushes that are not: the moment alone cannot tell two entries apart.
TEST(what_the_forces_tell_counts)
{
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 3;
    const size_t                one = 5, other = 34; // looked at before the others
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        struct dig_curve *const like = &set->curve[other * MADE_TRAJECTORIES + t];
        *like                        = set->curve[one * MADE_TRAJECTORIES + t];
        for (int k = 0; k < POINTS; k++) {
            like->mean[1][k] *= 1.6F;
        }
    }
    for (size_t slot = 0; slot < set->entries * MADE_TRAJECTORIES; slot++) {
        const size_t entry  = slot / MADE_TRAJECTORIES;
        set->packings[slot] = entry == one || entry == other ? PACKINGS : 0;
    }
    dig_outlines_draw(set);
    for (int trial = 0; trial < 20; trial++) {
        struct dig_observation dig = make_dig(&set->gravel[one], MADE_SIMPLE_A, true, &seed);
        for (int k = 0; k < POINTS; k++) {
            dig.force_N[0][k] *= trial % 2 == 0 ? 1.6 : 1.0;
        }
        struct dig_match match = { .valid = true, .nearest = (int)one };
        dig_match_find_weighted(set, 1, &dig, &match);
        assert_int_equal(match.weighted, trial % 2 == 0 ? other : one);
        dig.forces    = false;
        match.nearest = (int)other;
        dig_match_find_weighted(set, 1, &dig, &match);
        assert_int_equal(match.weighted, one); // the first of two that are equal
    }
    made_table_destroy(set);
}

// An entry that is known from one packing alone, and nearly as near: were its own D taken, it would
// be nearer, in what digs may be off it.
TEST(who_is_known_worst_is_not_the_nearest_to_all)
{
    struct dig_curve_set *const set = made_table(&options);
    enum { WORST = 20, OWN = 31 };
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        struct dig_curve *const like = &set->curve[WORST * MADE_TRAJECTORIES + t];
        *like                        = set->curve[OWN * MADE_TRAJECTORIES + t];
        for (int k = 0; k < POINTS; k++) {
            for (int c = 0; c < 3; c++) {
                like->mean[c][k] *= 1.05F; // the digs are 1.02 of its own
            }
        }
        set->packings[WORST * MADE_TRAJECTORIES + t] = 1;
        set->packings[OWN * MADE_TRAJECTORIES + t]   = 40;
    }
    dig_outlines_draw(set);
    for (int forces = 0; forces < 2; forces++) {
        struct dig_observation dig   = made_observation(&set->gravel[OWN], MADE_SIMPLE_A, 0.0);
        struct dig_match       match = { .valid = true, .nearest = WORST };
        dig.forces                   = forces == 1;
        for (int k = 0; k < POINTS; k++) {
            dig.moment_Nm[k] *= 1.02;
            dig.force_N[0][k] = -8.0 * dig.moment_Nm[k];
            dig.force_N[1][k] = 5.0 * dig.moment_Nm[k];
        }
        dig_match_find_weighted(set, 1, &dig, &match);
        assert_int_equal(match.weighted, OWN);
    }
    made_table_destroy(set);
}

TEST(where_nothing_can_be_compared_no_entry_is_told)
{
    struct dig_curve_set *const set   = made_table(&options);
    uint64_t                    seed  = 4;
    struct dig_match            match = { .valid = true };
    struct dig_observation      dig   = make_dig(&set->gravel[3], MADE_SIMPLE_A, true, &seed);
    dig.first                         = 0.5;
    dig.last                          = 0.55; // less than a block, or parts of two
    dig_match_find_weighted(set, 1, &dig, &match);
    assert_int_equal(match.weighted, -1);
    assert_true(isnan(match.weighted_distance));

    made_table_destroy(set);
}
