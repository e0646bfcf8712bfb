// Tests for estimator/match/nearest.c: the search by outlines beside one that looks at everything

#include "estimator/match/nearest.h"

#include "core/outline.h"
#include "estimator/match/match.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { MOMENT = DIG_CHANNEL_MY_Nm, POINTS = DIG_CURVE_POINTS };

// Entries without a grid; curves all 0, each dug.
static struct dig_curve_set *empty_set(const size_t entries, const size_t trajectories)
{
    struct dig_curve_set *const set = calloc(1, sizeof *set);
    set->tooth_m                    = 0.09;
    set->trajectories               = trajectories;
    set->entries                    = entries;
    set->gravel                     = calloc(entries, sizeof *set->gravel);
    set->packings                   = calloc(entries * trajectories, sizeof *set->packings);
    set->curve                      = calloc(entries * trajectories, sizeof *set->curve);
    set->outline = calloc(DIG_FORCE_CHANNELS * entries * trajectories, sizeof *set->outline);
    for (size_t i = 0; i < entries * trajectories; i++) {
        set->packings[i] = 3;
    }
    return set;
}

static float *moment_of(const struct dig_curve_set *const set, const size_t entry,
                        const size_t trajectory)
{
    return set->curve[entry * set->trajectories + trajectory].mean[MOMENT];
}

// A random walk: smooth over a few points, as a curve of the table is.
static void wander(float moment_Nm[], const double step, uint64_t *const seed)
{
    double at = model_normal(seed);
    for (int k = 0; k < POINTS; k++) {
        at += step * model_normal(seed);
        moment_Nm[k] = (float)at;
    }
}

static struct dig_observation observe(const float moment_Nm[], const int trajectory,
                                      const double noise, uint64_t *const seed)
{
    struct dig_observation o = { .trajectory = trajectory, .first = 0.0, .last = 1.0 };
    for (int k = 0; k < POINTS; k++) {
        o.moment_Nm[k] = (double)moment_Nm[k] + noise * model_normal(seed);
        o.sigma_Nm[k]  = 0.01;
    }
    return o;
}

// The oracle: every entry, every dig, every point; the first of several that are equally near.
static int look_everywhere(const struct dig_curve_set *const set, const size_t digs,
                           const struct dig_observation dig[])
{
    int    nearest = -1;
    double least   = INFINITY;
    for (size_t e = 0; e < set->entries; e++) {
        double miss = 0.0;
        for (size_t d = 0; d < digs; d++) {
            const size_t t = (size_t)dig[d].trajectory;
            for (int k = 0; k < POINTS; k++) {
                if (k / 255.0 >= dig[d].first && k / 255.0 <= dig[d].last) {
                    miss += pow(dig[d].moment_Nm[k] - (double)moment_of(set, e, t)[k], 2.0);
                }
            }
            miss = set->packings[e * set->trajectories + t] > 0 ? miss : (double)INFINITY;
        }
        if (miss < least) {
            least   = miss;
            nearest = (int)e;
        }
    }
    return nearest;
}

// By outlines of the set's curves as they are now.
static int nearest_of(struct dig_curve_set *const set, const size_t digs,
                      const struct dig_observation dig[])
{
    struct dig_match match = { .nearest = -1 };
    dig_outlines_draw(set);
    const enum dig_status status = dig_match_nearest(set, digs, dig, 2.5, &match);
    assert_int_equal(status, match.nearest >= 0 ? DIG_OK : DIG_ENOMATCH);
    return match.nearest;
}

TEST(it_finds_what_a_look_at_all_finds_in_smooth_families)
{
    const struct made_options   options = { .relative_sd = 0.15, .packings = 3 };
    struct dig_curve_set *const set     = made_table(&options);
    uint64_t                    seed    = 5;
    for (int trial = 0; trial < 150; trial++) {
        struct dig_observation  dig[DIG_POOL_MAX];
        const size_t            digs   = 1 + (size_t)trial % DIG_POOL_MAX;
        const struct dig_gravel gravel = { { 0.3 + 0.6 * model_uniform(&seed),
                                             0.1 + 0.9 * model_uniform(&seed),
                                             1500 + 2500 * model_uniform(&seed) } };
        for (size_t d = 0; d < digs; d++) {
            dig[d] =
                made_observation(&gravel, (enum made_trajectory)((d + (size_t)trial % 5) % 3), 0.0);
            made_disturb(&dig[d], 0.3, &seed);
            dig[d].first = trial % 3 == 0 ? 0.4 * model_uniform(&seed) : 0.0;
            dig[d].last  = trial % 4 == 0 ? 0.5 + 0.5 * model_uniform(&seed) : 1.0;
        }
        assert_int_equal(nearest_of(set, digs, dig), look_everywhere(set, digs, dig));
    }
    made_table_destroy(set);
}

TEST(it_finds_what_a_look_at_all_finds_among_random_curves)
{
    enum { ENTRIES = 400, TRAJECTORIES = 2 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, TRAJECTORIES);
    uint64_t                    seed = 11;
    for (size_t i = 0; i < ENTRIES * TRAJECTORIES; i++) {
        wander(set->curve[i].mean[MOMENT], i % 7 == 0 ? 2.0 : 0.05, &seed);
        set->packings[i] = i % 5 == 0 ? 0 : 3;
    }
    for (int trial = 0; trial < 60; trial++) {
        const int              t      = trial % TRAJECTORIES;
        const size_t           like   = (size_t)(model_uniform(&seed) * ENTRIES);
        struct dig_observation dig[2] = {
            observe(moment_of(set, like, (size_t)t), t, 0.3 * trial, &seed),
            observe(moment_of(set, like, 0), 0, 0.3 * trial, &seed),
        };
        dig[1].first = 0.1 * (trial % 6);
        assert_int_equal(nearest_of(set, 1, dig), look_everywhere(set, 1, dig));
        assert_int_equal(nearest_of(set, 2, dig), look_everywhere(set, 2, dig));
    }
    made_table_destroy(set);
}

TEST(of_entries_all_alike_it_finds_the_first_that_was_dug)
{
    enum { ENTRIES = 100 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, 1);
    uint64_t                    seed = 12;
    wander(moment_of(set, 0, 0), 0.1, &seed);
    for (size_t e = 1; e < ENTRIES; e++) {
        set->curve[e] = set->curve[0];
    }
    struct dig_observation dig = observe(moment_of(set, 0, 0), 0, 0.5, &seed);
    assert_int_equal(nearest_of(set, 1, &dig), 0);
    set->packings[0] = 0;
    assert_int_equal(nearest_of(set, 1, &dig), 1);
    for (size_t e = 0; e < 70; e++) {
        set->packings[e] = 0;
    }
    assert_int_equal(nearest_of(set, 1, &dig), 70);

    // Measured exactly: the distance is 0 and so is every bound.
    dig = observe(moment_of(set, 0, 0), 0, 0.0, &seed);
    assert_int_equal(nearest_of(set, 1, &dig), 70);
    made_table_destroy(set);
}

// A hair apart: less than what rounding moves an outline by. And outlines that are all the same.
TEST(what_no_outline_can_tell_apart_is_compared_in_full)
{
    enum { ENTRIES = 200 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, 1);
    uint64_t                    seed = 13;
    wander(moment_of(set, 0, 0), 0.1, &seed);
    for (size_t e = 1; e < ENTRIES; e++) {
        set->curve[e] = set->curve[0];
        for (int k = 0; k < POINTS; k++) {
            float *const at = &moment_of(set, e, 0)[k];
            *at             = model_uniform(&seed) < 0.5 ? nextafterf(*at, 1e9F) : *at;
        }
    }
    for (size_t like = 0; like < ENTRIES; like += 9) {
        const struct dig_observation dig = observe(moment_of(set, like, 0), 0, 0.0, &seed);
        assert_int_equal(nearest_of(set, 1, &dig), (int)like);
    }
    for (size_t e = 0; e < ENTRIES; e++) {
        for (int k = 0; k < POINTS; k += 2) {
            const float swing           = (float)model_uniform(&seed);
            moment_of(set, e, 0)[k]     = 1.0F + swing;
            moment_of(set, e, 0)[k + 1] = 1.0F - swing;
        }
    }
    for (size_t like = 0; like < ENTRIES; like += 9) {
        const struct dig_observation dig = observe(moment_of(set, like, 0), 0, 0.1, &seed);
        assert_int_equal(nearest_of(set, 1, &dig), look_everywhere(set, 1, &dig));
    }
    made_table_destroy(set);
}

// The smallest numbers there are have no digits to round to: an outline is off by half of itself.
TEST(the_smallest_numbers_are_compared)
{
    enum { ENTRIES = 200 };
    static const double         smallest = 0x1p-149;
    struct dig_curve_set *const set      = empty_set(ENTRIES, 1);
    uint64_t                    seed     = 19;
    for (int k = 0; k < POINTS; k++) {
        moment_of(set, 0, 0)[k] = (float)(floor(10.0 * model_uniform(&seed)) * smallest);
    }
    for (size_t e = 1; e < ENTRIES; e++) {
        set->curve[e] = set->curve[0];
        moment_of(set, e, 0)[e] += (float)smallest;
    }
    for (size_t like = 1; like < ENTRIES; like += 9) {
        const struct dig_observation dig = observe(moment_of(set, like, 0), 0, 0.0, &seed);
        assert_int_equal(nearest_of(set, 1, &dig), (int)like);
    }
    made_table_destroy(set);
}

TEST(numbers_of_any_size_are_compared)
{
    enum { ENTRIES = 60 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, 1);
    uint64_t                    seed = 14;
    for (int power = -40; power <= 36; power += 4) {
        for (size_t e = 0; e < ENTRIES; e++) {
            wander(moment_of(set, e, 0), 0.1, &seed);
            for (int k = 0; k < POINTS; k++) {
                moment_of(set, e, 0)[k] *= (float)pow(10.0, power);
            }
        }
        const struct dig_observation dig =
            observe(moment_of(set, 33, 0), 0, pow(10.0, power - 1), &seed);
        assert_int_equal(nearest_of(set, 1, &dig), look_everywhere(set, 1, &dig));
    }
    made_table_destroy(set);
}

TEST(curves_that_are_no_numbers_are_passed_over)
{
    enum { ENTRIES = 50 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, 1);
    uint64_t                    seed = 15;
    for (size_t e = 0; e < ENTRIES; e++) {
        wander(moment_of(set, e, 0), 0.1, &seed);
        for (int k = 0; k < POINTS; k++) {
            set->curve[e].sd[MOMENT][k] = NAN; // a spread no one knows does not move the distance
        }
    }
    const struct dig_observation dig = observe(moment_of(set, 34, 0), 0, 0.01, &seed);
    assert_int_equal(nearest_of(set, 1, &dig), 34);
    moment_of(set, 34, 0)[200] = NAN;
    moment_of(set, 17, 0)[10]  = -INFINITY;
    for (int k = 0; k < POINTS; k++) {
        moment_of(set, 0, 0)[k] = NAN;
    }
    const int second = look_everywhere(set, 1, &dig);
    assert_true(second != 34 && second > 0);
    assert_int_equal(nearest_of(set, 1, &dig), second);
    made_table_destroy(set);
}

TEST(one_entry_is_found_and_none_is_refused)
{
    struct dig_curve_set *const set  = empty_set(1, 1);
    uint64_t                    seed = 16;
    wander(moment_of(set, 0, 0), 0.1, &seed);
    const struct dig_observation dig = observe(moment_of(set, 0, 0), 0, 1.0, &seed);
    assert_int_equal(nearest_of(set, 1, &dig), 0);
    set->packings[0] = 0;
    assert_int_equal(nearest_of(set, 1, &dig), -1);
    made_table_destroy(set);
}

// Curves whose outline is far away are exchanged, behind the outlines' back, for what was measured:
// whoever looks at one finds it. The nearest is among those that the search begins with.
TEST(what_is_far_by_its_outline_is_not_looked_at)
{
    enum { ENTRIES = 300, NEAREST = 9 * 17 };
    struct dig_curve_set *const set  = empty_set(ENTRIES, 1);
    uint64_t                    seed = 18;
    for (size_t e = 0; e < ENTRIES; e++) {
        wander(moment_of(set, e, 0), 0.1, &seed);
        for (int k = 0; k < POINTS; k++) {
            moment_of(set, e, 0)[k] += e == NEAREST ? 0.0F : 50.0F;
        }
    }
    dig_outlines_draw(set);
    const struct dig_observation dig = observe(moment_of(set, NEAREST, 0), 0, 0.1, &seed);
    for (size_t e = 0; e < ENTRIES; e++) {
        for (int k = 0; k < POINTS && e != NEAREST; k++) {
            moment_of(set, e, 0)[k] = (float)dig.moment_Nm[k];
        }
    }
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, 1, &dig, 2.5, &match), DIG_OK);
    assert_int_equal(match.nearest, NEAREST);
    made_table_destroy(set);
}
