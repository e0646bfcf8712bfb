// Tests for estimator/match/posterior.c: what the forces add to the moment

#include "estimator/match/posterior.h"

#include "core/outline.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/entry_scatter.h"
#include "tests/estimator/fitted_match.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { CHANNELS = DIG_FORCE_CHANNELS, PACKINGS = 3 };
static const double              scatter = 0.1;
static const struct made_options flat    = { .relative_sd = 0.1,
                                             .packings    = PACKINGS,
                                             .one_density = true };

// Forces that tell what the moment does not: Fx of friction alone, Fz of rolling friction alone.
static double force_N(const struct dig_gravel *const gravel, const int force, const int point)
{
    const double p = point / (double)(DIG_CURVE_POINTS - 1);
    return force == 0 ? -8.0 * (0.5 + gravel->value[DIG_AXIS_FRICTION]) * (0.2 + p)
                      : 5.0 * (0.5 + gravel->value[DIG_AXIS_ROLLING]) * (1.2 - p);
}

static struct dig_curve_set *table_with_forces(void)
{
    struct dig_curve_set *const set = made_table(&flat);
    for (size_t e = 0; e < set->entries; e++) {
        for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
            struct dig_curve *const curve = &set->curve[e * MADE_TRAJECTORIES + t];
            for (int force = 0; force < 2; force++) {
                for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                    const double mean         = force_N(&set->gravel[e], force, k);
                    curve->mean[1 + force][k] = (float)mean;
                    curve->sd[1 + force][k]   = (float)(scatter * fabs(mean));
                }
            }
        }
    }
    dig_outlines_draw(set);
    return set;
}

// Errors of one dig relative to its mean, standard normal at each point, correlated along the dig
// and between channels.
static void draw(double error[CHANNELS][DIG_CURVE_POINTS], uint64_t *const seed)
{
    struct dig_observation one[CHANNELS];
    for (int c = 0; c < CHANNELS; c++) {
        one[c] = (struct dig_observation){ .trajectory = MADE_ACTUAL };
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            one[c].moment_Nm[k] = 1.0;
        }
        made_disturb(&one[c], 1.0, seed);
    }
    // Of channel c given those before it, regressed by hand.
    const double r01 = DIG_ENTRY_SCATTER_MY_FX, r02 = DIG_ENTRY_SCATTER_MY_FZ,
                 r12   = DIG_ENTRY_SCATTER_FX_FZ;
    const double left1 = sqrt(1.0 - r01 * r01);
    const double b1    = (r12 - r01 * r02) / left1;
    const double left2 = sqrt(1.0 - r02 * r02 - b1 * b1);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double z0 = one[0].moment_Nm[k] - 1.0, z1 = one[1].moment_Nm[k] - 1.0,
                     z2 = one[2].moment_Nm[k] - 1.0;
        error[0][k]     = z0;
        error[1][k]     = r01 * z0 + left1 * z1;
        error[2][k]     = r02 * z0 + b1 * z1 + left2 * z2;
    }
}

// Digs share what the table is wrong by.
static void dig_there(const struct dig_gravel *const gravel, const size_t digs,
                      struct dig_observation dig[], uint64_t *const seed)
{
    double shared[CHANNELS][DIG_CURVE_POINTS], own[CHANNELS][DIG_CURVE_POINTS];
    draw(shared, seed);
    for (size_t d = 0; d < digs; d++) {
        draw(own, seed);
        dig[d]        = made_observation(gravel, MADE_ACTUAL, 0.0);
        dig[d].forces = true;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const double off = shared[0][k] / sqrt(PACKINGS) + own[0][k];
            dig[d].moment_Nm[k] *= 1.0 + scatter * off;
            for (int force = 0; force < 2; force++) {
                // The spread is of the mean's size; the sign of the error is the channel's own.
                const double mean = force_N(gravel, force, k);
                dig[d].force_N[force][k] =
                    mean + scatter * fabs(mean) *
                               (shared[1 + force][k] / sqrt(PACKINGS) + own[1 + force][k]);
            }
        }
    }
}

TEST(forces_tell_more_and_never_too_much)
{
    enum { STEPS = 3 };
    static const struct {
        size_t      digs;
        bool        forces;
        const char *what;
    } step[STEPS] = { { 1, false, "1 dig, moment alone" },
                      { 1, true, "1 dig, moment and forces" },
                      { 4, true, "4 digs, moment and forces" } };

    struct dig_curve_set *const set         = table_with_forces();
    const int                   trials      = test_is_quick() ? 60 : 150;
    uint64_t                    seed        = 31;
    struct held                 held[STEPS] = { { 0 } };
    for (int trial = 0; trial < trials; trial++) {
        const struct dig_gravel gravel = random_gravel_of(&seed, 2500);
        struct dig_observation  dig[4];
        dig_there(&gravel, 4, dig, &seed);
        for (int s = 0; s < STEPS; s++) {
            dig[0].forces            = step[s].forces;
            const struct dig_match m = fit(set, step[s].digs, dig, 100);
            assert_true(m.forces == step[s].forces);
            held_add(&held[s], &m, &gravel);
        }
    }
    for (int s = 0; s < STEPS; s++) {
        held_expect(&held[s], 2, step[s].what);
        assert_true(held[s].in[0] < trials && held[s].in[1] < trials);
    }
    assert_true(held[1].width[0] < 0.9 * held[0].width[0]);
    assert_true(held[1].width[1] < 0.5 * held[0].width[1]);
    assert_true(held[2].width[0] < held[1].width[0] && held[2].width[1] < held[1].width[1]);
    made_table_destroy(set);
}

// One dig without forces, and the moment alone is compared: as if none had them.
TEST(forces_count_only_where_every_dig_has_them)
{
    struct dig_curve_set *const set  = table_with_forces();
    uint64_t                    seed = 8;
    struct dig_observation      dig[3];
    dig_there(&(struct dig_gravel){ { 0.6, 0.5, 2500 } }, 3, dig, &seed);
    dig[1].forces                = false;
    const struct dig_match mixed = fit(set, 3, dig, 100);
    dig[0].forces = dig[2].forces = false;
    const struct dig_match none   = fit(set, 3, dig, 100);
    assert_false(mixed.forces);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(mixed.low.value[a], none.low.value[a], 0.0);
        assert_close(mixed.high.value[a], none.high.value[a], 0.0);
    }

    dig[0].forces        = true;
    dig[0].force_N[1][7] = NAN;
    struct dig_match match;
    assert_int_equal(dig_match_nearest(set, 1, &dig[0], 2.5, &match), DIG_EINVAL);
    dig[0].force_N[1][7]       = 0.0;
    dig[0].force_sigma_N[0][7] = -1.0;
    assert_int_equal(dig_match_nearest(set, 1, &dig[0], 2.5, &match), DIG_EINVAL);
    made_table_destroy(set);
}

static void expect_the_same(const struct dig_match *const a, const struct dig_match *const b)
{
    for (int x = 0; x < DIG_AXES; x++) {
        assert_close(a->gravel.value[x], b->gravel.value[x], 0.0);
        assert_close(a->mean.value[x], b->mean.value[x], 0.0);
        assert_close(a->low.value[x], b->low.value[x], 0.0);
        assert_close(a->high.value[x], b->high.value[x], 0.0);
    }
    assert_int_equal(a->samples, b->samples);
    assert_memory_equal(a->sample, b->sample, a->samples * sizeof a->sample[0]);
    assert_close(a->distance, b->distance, 0.0);
    assert_close(a->noise_floor, b->noise_floor, 0.0);
}

// The moment of a gravel of the table, and a push that none has: outside, and the gravel is the one
// the moment alone tells. Digs of the table with the forces that belong to them are inside.
TEST(forces_that_no_gravel_has_are_told_and_done_without)
{
    struct dig_curve_set *const set  = table_with_forces();
    uint64_t                    seed = 77;
    for (int trial = 0; trial < 20; trial++) {
        const struct dig_gravel gravel = { { 0.4 + 0.4 * model_uniform(&seed),
                                             0.3 + 0.5 * model_uniform(&seed), 2500 } };
        const size_t            digs   = trial % 2 == 0 ? 1 : 3;
        struct dig_observation  dig[3];
        dig_there(&gravel, digs, dig, &seed);
        const struct dig_match inside = fit(set, digs, dig, 100);
        assert_true(inside.forces && !inside.outside);

        // Pushed twice as hard as by any friction, lifted half as hard as by any rolling friction.
        for (size_t d = 0; d < digs; d++) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                dig[d].force_N[0][k] *= 2.5;
                dig[d].force_N[1][k] *= 0.4;
            }
        }
        const struct dig_match outside = fit(set, digs, dig, 100);
        assert_true(outside.outside && !outside.forces);
        for (size_t d = 0; d < digs; d++) {
            dig[d].forces = false;
        }
        const struct dig_match bare = fit(set, digs, dig, 100);
        assert_false(bare.outside);
        expect_the_same(&outside, &bare);
    }
    made_table_destroy(set);
}

// Of digs in the gravel it is asked about the excess is a standard deviation of its own about 0, of
// whole digs and of parts, of one and of several: the same limit means the same for all.
TEST(excess_has_one_scale_for_digs_of_any_length)
{
    enum { CASES = 3, TRIALS = 200 };
    static const double         last[CASES] = { 1.0, 0.4, 1.0 };
    static const size_t         digs[CASES] = { 1, 1, 3 };
    struct dig_curve_set *const set         = table_with_forces();
    uint64_t                    seed        = 5;
    for (int c = 0; c < CASES; c++) {
        double sum = 0.0, sum2 = 0.0;
        for (int trial = 0; trial < TRIALS; trial++) {
            const struct dig_gravel gravel = random_gravel_of(&seed, 2500);
            struct dig_observation  dig[3];
            struct dig_pool_sums    sums;
            dig_there(&gravel, digs[c], dig, &seed);
            for (size_t d = 0; d < digs[c]; d++) {
                dig[d].last = last[c];
            }
            dig_pool_sum(digs[c], dig, &sums);
            const double excess = dig_posterior_excess(set, &sums, &gravel);
            sum += excess;
            sum2 += excess * excess;
        }
        const double mean = sum / TRIALS;
        const double sd   = sqrt(sum2 / TRIALS - mean * mean);
        print_message("%zu digs, %.1f of the path: excess %.2f +- %.2f\n", digs[c], last[c], mean,
                      sd);
        assert_true(fabs(mean) < 0.5 && sd > 0.5 && sd < 1.5);
    }
    const struct dig_gravel     none = { { 5.0, 0.5, 2500 } };
    const struct dig_gravel     some = { { 0.6, 0.5, 2500 } };
    struct dig_observation      dig  = made_observation(&some, MADE_ACTUAL, 0.0);
    static struct dig_pool_sums sums;
    dig_pool_sum(1, &dig, &sums);
    assert_true(isinf(dig_posterior_excess(set, &sums, &none)));
    made_table_destroy(set);
}
