// Tests for estimator/match/likelihood.c and prefilter.c: the formula written out, and what
// outlines lose

#include "estimator/match/likelihood.h"

#include "estimator/match/match.h"
#include "estimator/match/posterior.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS = DIG_CURVE_POINTS, PACKINGS = 3 };

static const struct made_options options = { .relative_sd = 0.15, .packings = PACKINGS };

static struct dig_prefilter sum_up(const struct dig_curve_set *const set,
                                   struct dig_outline **const        outline)
{
    struct dig_prefilter summary;
    *outline = calloc(dig_prefilter_outlines(set), sizeof **outline);
    dig_prefilter_make(set, *outline, &summary);
    return summary;
}

// The oracle, of an entry of the table itself: what posterior.h says, D inverted by its cofactors.
static double log_by_hand(const struct dig_curve_set *const set, const size_t entry,
                          const struct dig_pooled *const group)
{
    const double                  sign[3][3] = { { 1, DIG_POSTERIOR_MY_FX, DIG_POSTERIOR_MY_FZ },
                                                 { DIG_POSTERIOR_MY_FX, 1, DIG_POSTERIOR_FX_FZ },
                                                 { DIG_POSTERIOR_MY_FZ, DIG_POSTERIOR_FX_FZ, 1 } };
    const struct dig_curve *const c = &set->curve[entry * MADE_TRAJECTORIES + group->trajectory];
    const int                     n = group->forces ? 3 : 1;
    double                        mean2[3] = { 0.0 }, points = 0.0;
    for (int k = 0; k < POINTS; k++) {
        points += group->count[k] > 0.0 ? 1.0 : 0.0;
        for (int i = 0; i < n && group->count[k] > 0.0; i++) {
            mean2[i] += pow((double)c->mean[i][k], 2.0);
        }
    }
    double sum = 0.0;
    for (int k = 0; k < POINTS; k++) {
        if (!(group->count[k] > 0.0)) {
            continue;
        }
        const double m[3]      = { group->mean_Nm[k], group->force_N[0][k], group->force_N[1][k] };
        const double sigma2[3] = { group->sigma2_Nm2[k], group->force_sigma2_N2[0][k],
                                   group->force_sigma2_N2[1][k] };
        double       miss[3], spread[3], d[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
        for (int i = 0; i < n; i++) {
            // Made with one relative spread everywhere: it is the pooled one, too.
            const double t2 = pow((double)c->mean[i][k], 2.0);
            const double w  = 4.0 / (4.0 + PACKINGS - 1.0);
            const double s2 = (1.0 - w) * pow((double)c->sd[i][k], 2.0) + w * 0.15 * 0.15 * t2 +
                              pow(0.15 / 4.0, 2.0) * mean2[i] / points;
            miss[i]   = m[i] - (double)c->mean[i][k];
            spread[i] = sqrt(s2 * (1.0 / group->count[k] + 1.0 / PACKINGS));
        }
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                d[i][j] = sign[i][j] * spread[i] * spread[j];
            }
            d[i][i] += sigma2[i] / group->count[k];
        }
        double determinant = 0.0, squares = 0.0;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                const int    a = (i + 1) % 3, b = (i + 2) % 3, e = (j + 1) % 3, f = (j + 2) % 3;
                const double cofactor = d[a][e] * d[b][f] - d[a][f] * d[b][e];
                determinant += i == 0 ? d[0][j] * cofactor : 0.0;
                squares += i < n && j < n ? miss[i] * miss[j] * cofactor : 0.0;
            }
        }
        sum += squares / determinant + log(determinant);
    }
    const struct dig_trajectory t = made_trajectory((enum made_trajectory)group->trajectory);
    const double whole_m          = dig_trajectory_path_m(&t, 0.09, dig_trajectory_duration_s(&t));
    const double effective        = (points - 1.0) / 255.0 * whole_m / (0.25 * 0.09);
    return -0.5 * effective * sum / points;
}

static void it_is_the_formula_written_out(void **state)
{
    (void)state;
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 31;
    for (int trial = 0; trial < 40; trial++) {
        const enum made_trajectory along  = (enum made_trajectory)(trial % 3);
        const struct dig_gravel    gravel = random_gravel(&seed);
        struct dig_observation     dig[3];
        for (int d = 0; d < 3; d++) {
            dig[d]       = make_dig(&gravel, along, trial % 2 == 0, &seed);
            dig[d].first = trial % 5 == 0 ? 0.2 * d : 0.0;
            dig[d].last  = trial % 7 == 0 ? 0.9 : 1.0;
        }
        struct dig_pool_sums sums;
        dig_pool_sum(1 + (size_t)trial % 3, dig, &sums);
        struct dig_likelihood likelihood;
        dig_likelihood_make(set, NULL, &sums.group[0], &likelihood);
        for (size_t e = 0; e < set->entries; e += 5) {
            struct dig_cell cell;
            assert_int_equal(dig_cell_find(set, &set->gravel[e], (size_t)along, &cell), DIG_OK);
            const double expected = log_by_hand(set, e, &sums.group[0]);
            assert_close(dig_likelihood_log(&likelihood, &cell), expected,
                         1e-6 * (1.0 + fabs(expected)));
        }
    }
    made_table_destroy(set);
}

static void an_outline_has_the_means_of_blocks_and_none_of_what_was_not_dug(void **state)
{
    (void)state;
    struct dig_curve_set *const set          = made_table(&options);
    set->packings[4 * MADE_TRAJECTORIES + 1] = 0;
    struct dig_outline        *outline       = NULL;
    const struct dig_prefilter summary       = sum_up(set, &outline);
    for (size_t slot = 0; slot < set->entries * set->trajectories; slot++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
                double mean = 0.0, sd = 0.0;
                for (int k = 0; k < POINTS; k++) {
                    const bool inside = k * DIG_OUTLINE_BLOCKS / POINTS == b;
                    mean += inside ? (double)set->curve[slot].mean[c][k] : 0.0;
                    sd += inside ? (double)set->curve[slot].sd[c][k] : 0.0;
                }
                const double mean_told = (double)dig_outline_mean(&summary, c, slot)[b];
                const double sd_told   = (double)dig_outline_sd(&summary, c, slot)[b];
                if (slot == 4 * MADE_TRAJECTORIES + 1) {
                    assert_true(isnan(mean_told) && isnan(sd_told));
                    continue;
                }
                assert_close(mean_told * 16.0, mean, 1e-5 * (1.0 + fabs(mean)));
                assert_close(sd_told * 16.0, sd, 1e-5 * (1.0 + fabs(sd)));
            }
        }
    }
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            assert_close(summary.relative2[t][c], 0.15 * 0.15, 1e-7);
        }
    }
    free(outline);
    made_table_destroy(set);
}

// Curves that are level within each block lose nothing in an outline: the rough likelihoods of
// two entries are as far apart as the true ones.
static void of_curves_that_are_level_in_blocks_the_rough_likelihood_is_the_true_one(void **state)
{
    (void)state;
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 32;
    for (size_t i = 0; i < set->entries * set->trajectories; i++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int k = 0; k < POINTS; k++) {
                set->curve[i].mean[c][k] = set->curve[i].mean[c][k / 16 * 16 + 8];
                set->curve[i].sd[c][k]   = set->curve[i].sd[c][k / 16 * 16 + 8];
            }
        }
    }
    struct dig_outline        *outline = NULL;
    const struct dig_prefilter summary = sum_up(set, &outline);
    for (int forces = 0; forces < 2; forces++) {
        struct dig_observation dig = make_dig(&set->gravel[20], MADE_ACTUAL, forces == 1, &seed);
        for (int k = 0; k < POINTS; k++) {
            const int b       = k / 16 * 16 + 8;
            dig.moment_Nm[k]  = dig.moment_Nm[b];
            dig.sigma_Nm[k]   = dig.sigma_Nm[b];
            dig.force_N[0][k] = dig.force_N[0][b], dig.force_N[1][k] = dig.force_N[1][b];
            dig.force_sigma_N[0][k] = dig.force_sigma_N[1][k] = 0.1;
        }
        struct dig_pool_sums sums;
        dig_pool_sum(1, &dig, &sums);
        struct dig_likelihood whole, rough;
        dig_likelihood_make(set, NULL, &sums.group[0], &whole);
        rough = whole;
        assert_true(dig_likelihood_outline(&summary, &rough));
        for (size_t e = 0; e < set->entries; e++) {
            struct dig_cell cell;
            assert_int_equal(dig_cell_find(set, &set->gravel[e], MADE_ACTUAL, &cell), DIG_OK);
            const double expected = dig_likelihood_log(&whole, &cell);
            assert_close(dig_likelihood_log(&rough, &cell), expected,
                         1e-4 * (1.0 + fabs(expected)));
        }
    }
    free(outline);
    made_table_destroy(set);
}

static void a_dig_of_which_no_block_is_whole_has_no_outline(void **state)
{
    (void)state;
    struct dig_curve_set *const set     = made_table(&options);
    uint64_t                    seed    = 33;
    struct dig_outline         *outline = NULL;
    const struct dig_prefilter  summary = sum_up(set, &outline);
    struct dig_observation      dig     = make_dig(&set->gravel[20], MADE_ACTUAL, false, &seed);
    dig.first = 0.03, dig.last = 0.12; // points 8 to 30
    struct dig_pool_sums sums;
    dig_pool_sum(1, &dig, &sums);
    struct dig_likelihood likelihood;
    dig_likelihood_make(set, NULL, &sums.group[0], &likelihood);
    assert_false(dig_likelihood_outline(&summary, &likelihood));
    assert_true(likelihood.rough == NULL && likelihood.count == POINTS);
    dig.first = 0.0;
    dig_pool_sum(1, &dig, &sums);
    dig_likelihood_make(set, NULL, &sums.group[0], &likelihood);
    assert_true(dig_likelihood_outline(&summary, &likelihood));
    free(outline);
    made_table_destroy(set);
}

// What the outlines leave out does not move the answer; with a hole, and of a part of a path, too.
static void a_summary_changes_nothing_that_matters(void **state)
{
    (void)state;
    struct made_options holed           = options;
    holed.hole                          = true;
    struct dig_curve_set *const set     = made_table(&holed);
    uint64_t                    seed    = 34;
    struct dig_outline         *outline = NULL;
    const struct dig_prefilter  summary = sum_up(set, &outline);
    for (int trial = 0; trial < 8; trial++) {
        const struct dig_gravel gravel = random_gravel(&seed);
        struct dig_observation  dig[2] = {
             make_dig(&gravel, MADE_SIMPLE_A, trial % 2 == 1, &seed),
             make_dig(&gravel, MADE_SIMPLE_B, trial % 2 == 1, &seed),
        };
        dig[0].last       = trial % 4 < 2 ? 1.0 : 0.55;
        const size_t digs = 1 + (size_t)trial / 4;

        struct dig_match plain, by;
        assert_int_equal(dig_match_nearest(set, NULL, digs, dig, 2.5, &plain), DIG_OK);
        assert_int_equal(dig_match_nearest(summary.set, &summary, digs, dig, 2.5, &by), DIG_OK);
        assert_int_equal(dig_fit_refine(set, NULL, digs, dig, 100, &plain), DIG_OK);
        assert_int_equal(dig_fit_refine(summary.set, &summary, digs, dig, 100, &by), DIG_OK);
        for (int a = 0; a < DIG_AXES; a++) {
            const double share = 1e-4 * (a == DIG_AXIS_DENSITY_kgpm3 ? 2500.0 : 1.0);
            assert_close(by.mean.value[a], plain.mean.value[a], share);
            assert_close(by.mode.value[a], plain.mode.value[a], 0.0);
            assert_close(by.low.value[a], plain.low.value[a], share);
            assert_close(by.high.value[a], plain.high.value[a], share);
        }
        assert_int_equal(by.samples, plain.samples);
        assert_int_equal(by.forces, plain.forces);
    }
    free(outline);
    made_table_destroy(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_formula_written_out),
        cmocka_unit_test(an_outline_has_the_means_of_blocks_and_none_of_what_was_not_dug),
        cmocka_unit_test(of_curves_that_are_level_in_blocks_the_rough_likelihood_is_the_true_one),
        cmocka_unit_test(a_dig_of_which_no_block_is_whole_has_no_outline),
        cmocka_unit_test(a_summary_changes_nothing_that_matters),
    };
    return cmocka_run_group_tests_name("likelihood", tests, NULL, NULL);
}
