// Tests for estimator/match/prefilter.c: what an outline holds, and that nothing changes by it

#include "estimator/match/prefilter.h"

#include "estimator/match/gaussian.h"
#include "estimator/match/match.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

#include <stdlib.h>

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

TEST(an_outline_has_the_means_of_blocks_and_none_of_what_was_not_dug)
{
    struct dig_curve_set *const set          = made_table(&options);
    set->packings[4 * MADE_TRAJECTORIES + 1] = 0;
    struct dig_outline        *outline       = NULL;
    const struct dig_prefilter summary       = sum_up(set, &outline);
    for (size_t slot = 0; slot < set->entries * set->trajectories; slot++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
                double mean = 0.0;
                for (int k = 0; k < POINTS; k++) {
                    const bool inside = k * DIG_OUTLINE_BLOCKS / POINTS == b;
                    mean += inside ? (double)set->curve[slot].mean[c][k] : 0.0;
                }
                const double mean_told = (double)dig_outline_mean(&summary, c, slot)[b];
                if (slot == 4 * MADE_TRAJECTORIES + 1) {
                    assert_true(isnan(mean_told));
                    continue;
                }
                assert_close(mean_told * 16.0, mean, 1e-5 * (1.0 + fabs(mean)));
            }
        }
    }
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double sum = 0.0;
            for (size_t b = 0; b < DIG_COVARIANCE_BLOCKS; b++) {
                sum += summary.relative2[t][c * DIG_COVARIANCE_BLOCKS + b];
            }
            assert_close(sum / DIG_COVARIANCE_BLOCKS, 0.15 * 0.15, 1e-7);
        }
    }
    free(outline);
    made_table_destroy(set);
}

// Block means are drawn once or at every look: the likelihood is the same.
TEST(a_likelihood_by_outlines_is_that_by_curves)
{
    struct dig_curve_set *const set     = made_table(&options);
    uint64_t                    seed    = 32;
    struct dig_outline         *outline = NULL;
    const struct dig_prefilter  summary = sum_up(set, &outline);
    for (int trial = 0; trial < 20; trial++) {
        const struct dig_gravel at  = random_gravel(&seed);
        struct dig_observation  dig = make_dig(&at, MADE_ACTUAL, trial % 2 == 1, &seed);
        struct dig_pool_sums    sums;
        struct dig_gaussian     by_curves, by_outlines;
        struct dig_cell         cell;
        dig_pool_sum(1, &dig, &sums);
        dig_gaussian_make(set, NULL, &sums.group[0], &by_curves);
        dig_gaussian_make(set, &summary, &sums.group[0], &by_outlines);
        assert_int_equal(dig_cell_find(set, &at, MADE_ACTUAL, &cell), DIG_OK);
        assert_close(dig_gaussian_log(&by_outlines, &cell), dig_gaussian_log(&by_curves, &cell),
                     0.0);
    }
    free(outline);
    made_table_destroy(set);
}

// What the outlines leave out does not move the answer; with a hole, and of a part of a path, too.
TEST(a_summary_changes_nothing_that_matters)
{
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
