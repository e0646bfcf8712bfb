// Tests for estimator/match/gaussian.c: what is asked of a table's covariance, the formula in what
// digs made by it show, and the posterior that follows. That D is built as written is tested by
// test_weighted.c.

#include "estimator/match/gaussian.h"

#include "core/outline.h"
#include "tests/estimator/fitted_match.h"
#include "tests/estimator/random_dig.h"

#include <stdlib.h>
#include <string.h>

enum { N = DIG_COVARIANCE_NUMBERS, BLOCKS = DIG_COVARIANCE_BLOCKS, POINTS = DIG_CURVE_POINTS };
enum { WIDE = POINTS / BLOCKS, PACKINGS = 4 };
static const double enough_freedom = 200.0; // degrees of freedom

static const struct made_options options = { .relative_sd = 0.15, .packings = PACKINGS };

// Errors of the block means of one dig, relative to the size of the curve: what all blocks share,
// of other sign in Fx, and what neighbours share; or each by itself.
static void draw(const bool together, uint64_t *const seed, double error[N])
{
    const double shared = together ? 0.08 * model_normal(seed) : 0.0;
    double       last   = 0.0;
    for (int i = 0; i < N; i++) {
        last     = (together && i % BLOCKS > 0 ? 0.6 * last : 0.0) + 0.06 * model_normal(seed);
        error[i] = last + (i / BLOCKS == 1 ? -shared : shared);
    }
}

static struct dig_curve_set *taught(const double freedom, const bool together, uint64_t *const seed)
{
    enum { DIGS = 4000 };
    struct dig_curve_set *const set = made_table(&options);
    set->covariance                 = calloc(MADE_TRAJECTORIES, sizeof *set->covariance);
    for (int dig = 0; dig < DIGS; dig++) {
        double error[N];
        draw(together, seed, error);
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                set->covariance[MADE_SIMPLE_A].of[i][j] += error[i] * error[j] / DIGS;
            }
        }
    }
    set->covariance[MADE_SIMPLE_A].freedom = freedom;
    return set;
}

static void forget(struct dig_curve_set *const set)
{
    free(set->covariance);
    set->covariance = NULL;
    made_table_destroy(set);
}

// A dig of a gravel whose table's mean is off, too: as by that many packings.
static struct dig_observation dig_there(const struct dig_gravel *const gravel, const bool forces,
                                        const bool together, uint64_t *const seed)
{
    static const double    by[] = { 1.0, -8.0, 5.0 };
    struct dig_observation o    = made_observation(gravel, MADE_SIMPLE_A, 0.0);
    double                 own[N], size = 0.0;
    draw(together, seed, own);
    for (int p = 0; p < PACKINGS; p++) {
        double table[N];
        draw(together, seed, table);
        for (int i = 0; i < N; i++) {
            own[i] -= table[i] / PACKINGS;
        }
    }
    for (int b = 0; b < BLOCKS; b++) {
        double sum = 0.0;
        for (int k = b * WIDE; k < (b + 1) * WIDE; k++) {
            sum += o.moment_Nm[k] / WIDE;
        }
        size += sum * sum / BLOCKS;
    }
    o.forces = forces;
    for (int k = 0; k < POINTS; k++) {
        const double mean = o.moment_Nm[k];
        o.moment_Nm[k] += sqrt(size) * own[k / WIDE];
        for (int f = 1; f < 3; f++) {
            o.force_N[f - 1][k] =
                by[f] * mean + fabs(by[f]) * sqrt(size) * own[f * BLOCKS + k / WIDE];
        }
    }
    return o;
}

// Where numbers are independent q is as large as there are numbers: chi-square, four standard
// errors of its mean. Where they go together it is somewhat less, as each is given a share of its
// own and correlations are drawn towards even ones, and never more.
TEST(misses_are_as_large_as_digs_make_them)
{
    enum { TRIALS = 300 };
    for (int way = 0; way < 4; way++) {
        const bool                  forces = way % 2 == 1, together = way / 2 == 1;
        uint64_t                    seed = 5;
        double                      sum  = 0.0;
        struct dig_curve_set *const set  = taught(enough_freedom, together, &seed);
        for (int trial = 0; trial < TRIALS; trial++) {
            const struct dig_gravel *const gravel = &set->gravel[trial % 48];
            const struct dig_observation   dig    = dig_there(gravel, forces, together, &seed);
            struct dig_pool_sums           sums;
            struct dig_gaussian            g;
            struct dig_cell                cell;
            dig_pool_sum(1, &dig, &sums);
            dig_gaussian_make(set, &sums.group[0], &g);
            assert_int_equal(g.numbers, forces ? N : BLOCKS);
            assert_int_equal(dig_cell_find(set, gravel, MADE_SIMPLE_A, &cell), DIG_OK);
            sum += dig_gaussian_mahalanobis(&g, &cell).square / (double)g.numbers / TRIALS;
        }
        const double error = sqrt(2.0 / (TRIALS * (forces ? N : BLOCKS)));
        print_message("%s, %s: mean q over numbers %.3f\n", forces ? "moment and forces" : "moment",
                      together ? "together" : "each by itself", sum);
        assert_true(sum < 1.0 + 4.0 * error && sum > (together ? 0.7 : 1.0 - 4.0 * error));
        forget(set);
    }
}

// Friction of two drives, one of which turns about, the same in all digs of a machine; half as
// large in the moment as digs scatter, or twice.
static void rub(const double share, const double of[2], struct dig_observation *const o)
{
    for (int k = 0; k < POINTS; k++) {
        const double by[3][2] = { { share, 0.0 },
                                  { -8.0 * share, 4.0 * share },
                                  { 5.0 * share * k / POINTS, k < 100 ? share : -share } };
        for (int c = 0; c < 3; c++) {
            double *const value = c == 0 ? &o->moment_Nm[k] : &o->force_N[c - 1][k];
            double *const sigma = c == 0 ? &o->sigma_Nm[k] : &o->force_sigma_N[c - 1][k];
            for (int j = 0; j < 2; j++) {
                *value += of[j] * by[c][j];
                *sigma           = hypot(*sigma, by[c][j]);
                o->rubs[j][c][k] = (float)by[c][j];
            }
        }
    }
}

// Whatever friction a machine has, its digs miss by no more than digs without.
TEST(misses_by_friction_are_no_larger_the_more_there_is)
{
    enum { TRIALS = 200, DIGS = 3 };
    static const double shares[] = { 0.0, 0.02, 0.2, 2.0 };
    double              without  = 0.0;
    for (size_t s = 0; s < sizeof shares / sizeof shares[0]; s++) {
        uint64_t                    seed = 6;
        double                      sum  = 0.0;
        struct dig_curve_set *const set  = taught(enough_freedom, true, &seed);
        for (int trial = 0; trial < TRIALS; trial++) {
            const struct dig_gravel *const gravel = &set->gravel[trial % 48];
            const double                   of[2]  = { model_normal(&seed), model_normal(&seed) };
            struct dig_observation         dig[DIGS];
            struct dig_pool_sums           sums;
            struct dig_gaussian            g;
            struct dig_cell                cell;
            for (int d = 0; d < DIGS; d++) {
                dig[d] = dig_there(gravel, true, true, &seed);
                rub(shares[s], of, &dig[d]);
            }
            dig_pool_sum(DIGS, dig, &sums);
            dig_gaussian_make(set, &sums.group[0], &g);
            assert_int_equal(dig_cell_find(set, gravel, MADE_SIMPLE_A, &cell), DIG_OK);
            sum += dig_gaussian_mahalanobis(&g, &cell).square / (double)g.numbers / TRIALS;
        }
        print_message("friction %.2f: mean q over numbers %.3f\n", shares[s], sum);
        without = s == 0 ? sum : without;
        assert_close(sum, without, 0.05 * without);
        forget(set);
    }
}

// The posterior's interval holds the gravel of nine digs in ten, or a little more: the logarithm
// counts by less than it would.
TEST(the_interval_holds_the_gravel)
{
    const int                   trials = test_is_quick() ? 60 : 200;
    uint64_t                    seed   = 11;
    struct dig_curve_set *const set    = taught(enough_freedom, true, &seed);
    struct held                 held   = { 0 };
    for (int trial = 0; trial < trials; trial++) {
        const struct dig_gravel      gravel = random_gravel(&seed);
        const struct dig_observation dig    = dig_there(&gravel, true, true, &seed);
        const struct dig_match       match  = fit(set, 1, &dig, 100);
        held_add(&held, &match, &gravel);
    }
    for (int a = 0; a < DIG_AXES; a++) {
        print_message("axis %d: %d of %d in the interval\n", a, held.in[a], trials);
        assert_true(held.in[a] > trials * (0.9 - 3.0 * sqrt(0.9 * 0.1 / trials)));
    }
    forget(set);
}

static double log_of(const struct dig_curve_set *const set, const struct dig_pool_sums *const sums)
{
    struct dig_gaussian g;
    struct dig_cell     cell;
    dig_gaussian_make(set, &sums->group[0], &g);
    assert_int_equal(dig_cell_find(set, &set->gravel[9], MADE_SIMPLE_A, &cell), DIG_OK);
    const struct dig_mahalanobis misses = dig_gaussian_mahalanobis(&g, &cell);
    assert_close(dig_gaussian_log(&g, &cell), -0.35 * (misses.square + misses.log_det), 1e-9);
    return dig_gaussian_log(&g, &cell);
}

// What is too little to be believed is not used: the likelihood is the one without it.
TEST(a_covariance_of_too_few_packings_is_not_believed)
{
    uint64_t                     seed = 3;
    struct dig_curve_set *const  set  = taught(23.0, true, &seed);
    const struct dig_observation dig  = dig_there(&set->gravel[7], true, true, &seed);
    struct dig_pool_sums         sums;
    dig_pool_sum(1, &dig, &sums);
    const double few = log_of(set, &sums);
    set->covariance[MADE_SIMPLE_A].freedom += 1.0;
    const double                 more       = log_of(set, &sums);
    struct dig_covariance *const covariance = set->covariance;
    set->covariance                         = NULL;
    assert_close(few, log_of(set, &sums), 0.0);
    assert_true(fabs(few - more) > 0.1);
    set->covariance = covariance;
    forget(set);
}

// An error of the curve is as so many packings fewer: with one of sqrt(S_ii / 12) a mean of four is
// known as one of three. Of one channel whose numbers all scatter alike.
TEST(an_error_of_the_curve_is_as_fewer_packings)
{
    enum { FEWER = 3 };
    uint64_t                     seed = 21;
    struct dig_curve_set *const  set  = taught(enough_freedom, false, &seed);
    const struct dig_observation dig  = dig_there(&set->gravel[9], false, false, &seed);
    struct dig_covariance *const c    = &set->covariance[MADE_SIMPLE_A];
    struct dig_pool_sums         sums;
    for (int i = 0; i < N; i++) {
        c->of[i][i] = 0.0036;
    }
    dig_pool_sum(1, &dig, &sums);
    const size_t slot    = 9 * MADE_TRAJECTORIES + MADE_SIMPLE_A;
    const double without = log_of(set, &sums);
    set->packings[slot]  = FEWER;
    dig_outlines_draw(set);
    const double fewer        = log_of(set, &sums);
    set->packings[slot]       = PACKINGS;
    set->curve[slot].error[0] = (float)sqrt(0.0036 * (1.0 / FEWER - 1.0 / PACKINGS));
    dig_outlines_draw(set);
    assert_close(log_of(set, &sums), fewer, 1e-6 * fabs(fewer));
    assert_true(fabs(fewer - without) > 1e-3);
    forget(set);
}

// Halves of blocks that were not measured whole are left out, and the rest is compared.
TEST(what_was_not_measured_is_not_compared)
{
    uint64_t                    seed = 8;
    struct dig_curve_set *const set  = taught(enough_freedom, true, &seed);
    static const struct {
        double first, last;
        size_t numbers;
    } cases[] = { { 0.0, 1.0, 8 },  { 0.0, 0.499, 4 }, { 0.0, 0.57, 5 }, { 0.06, 1.0, 8 },
                  { 0.13, 1.0, 7 }, { 0.5, 0.52, 0 },  { 0.4, 0.42, 0 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct dig_observation dig = dig_there(&set->gravel[7], false, true, &seed);
        struct dig_pool_sums   sums;
        struct dig_gaussian    g;
        struct dig_cell        cell;
        dig.first = cases[i].first;
        dig.last  = cases[i].last;
        dig_pool_sum(1, &dig, &sums);
        dig_gaussian_make(set, &sums.group[0], &g);
        assert_int_equal(g.numbers, cases[i].numbers);
        if (cases[i].numbers == 0) {
            continue;
        }
        // What lies where nothing was measured makes no difference.
        assert_int_equal(dig_cell_find(set, &set->gravel[9], MADE_SIMPLE_A, &cell), DIG_OK);
        const struct dig_mahalanobis before = dig_gaussian_mahalanobis(&g, &cell);
        for (int k = 0; k < POINTS; k++) {
            if (k / 255.0 < dig.first || k / 255.0 > dig.last) {
                dig.moment_Nm[k] = 1e3;
            }
        }
        dig_pool_sum(1, &dig, &sums);
        dig_gaussian_make(set, &sums.group[0], &g);
        assert_close(dig_gaussian_mahalanobis(&g, &cell).square, before.square, 0.0);
        assert_close(dig_gaussian_mahalanobis(&g, &cell).log_det, before.log_det, 0.0);
    }
    forget(set);
}
