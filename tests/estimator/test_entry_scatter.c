// Tests for estimator/match/entry_scatter.c

#include "estimator/match/entry_scatter.h"

#include "core/units.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/table_runs.h"
#include "tests/testlib.h"

#include <stdlib.h>

static double whole_L(const struct dig_trajectory *const t)
{
    return dig_trajectory_path_m(t, 0.09, dig_trajectory_duration_s(t)) / 0.09;
}

// Two points so far apart, in bucket lengths.
static double correlation(const double apart_L)
{
    const double width_L = DIG_ENTRY_SCATTER_WIDTH;
    return (1.0 - DIG_ENTRY_SCATTER_SHARED) * exp(-DIG_PI * pow(apart_L / width_L, 2.0)) +
           DIG_ENTRY_SCATTER_SHARED;
}

// Of what packings are off their gravel's mean, in its standard deviations, over all gravels along
// one trajectory: how alike two points of one packing are.
static double shown(const struct table_runs *const t, const size_t trajectory,
                    const enum dig_channel c, const size_t apart)
{
    const size_t trajectories = t->set->trajectories;
    double       sum = 0.0, points = 0.0;
    for (size_t i = 0; i < t->runs; i++) {
        const size_t slot = table_run_slot(t, &t->run[i]);
        if (slot % trajectories != trajectory) {
            continue;
        }
        // Off a mean that has the packing in it, by so much less.
        const double            n     = t->set->packings[slot];
        const struct dig_curve *curve = &t->set->curve[slot];
        for (size_t k = 0; k + apart < DIG_CURVE_POINTS; k++) {
            const double sd = (double)curve->sd[c][k] * (double)curve->sd[c][k + apart];
            if (sd > 0.0) {
                sum += (t->run[i].value[c][k] - (double)curve->mean[c][k]) *
                       (t->run[i].value[c][k + apart] - (double)curve->mean[c][k + apart]) / sd *
                       n / (n - 1.0);
                points += 1.0;
            }
        }
    }
    return sum / points;
}

TEST(packings_of_the_table_are_correlated_along_the_path_as_told)
{
    struct table_runs *const t = calloc(1, sizeof *t);
    assert_non_null(t);
    assert_int_equal(table_runs_read("tables/reference_rig.sqlite", NULL, t, NULL), DIG_OK);
    for (size_t j = 0; j < t->set->trajectories; j++) {
        const double point_L = whole_L(&t->set->trajectory[j]) / (DIG_CURVE_POINTS - 1);
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double most = 0.0, far = 0.0, fars = 0.0;
            for (size_t apart = 0; (double)apart * point_L < 0.4; apart++) {
                const double off =
                    shown(t, j, (enum dig_channel)c, apart) - correlation((double)apart * point_L);
                most = fmax(most, fabs(off));
            }
            for (double L = 0.5; L < 0.75 * whole_L(&t->set->trajectory[j]); L += 0.05) {
                far += shown(t, j, (enum dig_channel)c, (size_t)(L / point_L));
                fars += 1.0;
            }
            print_message("%s, channel %d: at most %.2f off, %.3f far apart\n",
                          t->set->trajectory[j].name, c, most, far / fars);
            assert_true(most < 0.15);
            assert_close(far / fars, DIG_ENTRY_SCATTER_SHARED, 0.05);
        }
    }
    dig_curve_set_destroy(t->set);
    free(t);
}

TEST(draws_have_the_variance_and_the_width_they_are_of)
{
    enum { DRAWS = 2000 };
    static struct dig_entry_scatter spread;
    static double                   draw[DRAWS][DIG_CURVE_POINTS];
    const struct dig_trajectory     actual = made_trajectory(MADE_ACTUAL);
    uint64_t                        seed   = 1;
    dig_entry_scatter_make(&actual, 0.09, &spread);
    for (size_t d = 0; d < DRAWS; d++) {
        dig_entry_scatter_draw(&spread, &seed, draw[d]);
    }
    const double point_L = whole_L(&actual) / (DIG_CURVE_POINTS - 1);
    for (size_t apart = 0; apart < 60; apart += 5) {
        double sum = 0.0, points = 0.0;
        for (size_t k = 0; k + apart < DIG_CURVE_POINTS; k++) {
            for (size_t d = 0; d < DRAWS; d++) {
                sum += draw[d][k] * draw[d][k + apart];
                points += 1.0;
            }
        }
        assert_close(sum / points, correlation((double)apart * point_L), 0.02);
    }
}

// Against the sum over all pairs of points and channels.
TEST(the_variance_of_a_sum_is_that_of_all_its_pairs)
{
    static const double r[DIG_FORCE_CHANNELS][DIG_FORCE_CHANNELS] = { { 1.0, -0.93, 0.63 },
                                                                      { -0.93, 1.0, -0.49 },
                                                                      { 0.63, -0.49, 1.0 } };
    static struct dig_entry_scatter spread;
    uint64_t                        seed = 5;
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        const struct dig_trajectory trajectory = made_trajectory((enum made_trajectory)t);
        const double                point_L    = whole_L(&trajectory) / (DIG_CURVE_POINTS - 1);
        struct dig_channels         weight;
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const double first = model_normal(&seed), slope = model_normal(&seed);
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                weight.of[c][k] = first + slope * k / 255.0;
            }
        }
        double sum = 0.0;
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (int o = 0; o < DIG_FORCE_CHANNELS; o++) {
                for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                    for (int l = 0; l < DIG_CURVE_POINTS; l++) {
                        sum += weight.of[c][k] * weight.of[o][l] * r[c][o] *
                               correlation(abs(k - l) * point_L);
                    }
                }
            }
        }
        dig_entry_scatter_make(&trajectory, 0.09, &spread);
        assert_close(dig_entry_scatter_variance(&spread, &weight) / sum, 1.0, 1e-3);
    }
}
