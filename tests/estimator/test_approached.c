// Tests for estimator/approach/approaches.c, approach_response.c, approach_error.c and approached.c
// on a table whose curves are known at every depth and attack.

#include "estimator/approach/approached.h"
#include "estimator/predict/forecast.h"

#include "estimator/approach/approaches.h"
#include "estimator/match/match.h"
#include "estimator/predict/predict.h"
#include "tests/testlib.h"

#include "tests/approach_table.h"

#define DEG DIG_RAD_PER_DEG

// A curve is read off between its points, 1/255 of the path apart: where a phase ends it has a
// kink, at which a straight line is off by up to a quarter of a step, and a step is 0.034 at most.
#define READ_OFF 8e-3

static struct approach_table table;

static const struct dig_approach cross[] = {
    { 0.85, 0.0 }, { 1.0, -5.0 * DEG }, { 1.0, 5.0 * DEG }, { 1.15, 0.0 }
};
static const struct dig_approach product[] = {
    { 0.85, -5.0 * DEG }, { 0.85, 0.0 },        { 0.85, 5.0 * DEG }, { 1.0, -5.0 * DEG },
    { 1.0, 5.0 * DEG },   { 1.15, -5.0 * DEG }, { 1.15, 0.0 },       { 1.15, 5.0 * DEG },
};

static double straight(const double depth, const double attack_rad)
{
    return 1.0 + 2.0 * (depth - 1.0) - 1.5 * attack_rad;
}

static double twisted(const double depth, const double attack_rad)
{
    return straight(depth, attack_rad) + 40.0 * (depth - 1.0) * attack_rad;
}

static void *memory;

static const struct dig_curve_set *make(const size_t trajectory, const double depth,
                                        const double attack_deg)
{
    const struct dig_approached_slot slot = { trajectory, { depth, attack_deg * DEG }, 0.0, NULL };
    free(memory);
    memory = malloc(dig_approached_size(&table.cube.set, 1));
    assert_non_null(memory);
    return dig_approached_make(&table.cube.set, 1, &slot, NULL, memory);
}

static int tear_down(void **state)
{
    (void)state;
    free(memory);
    memory = NULL;
    return 0;
}

// The largest difference from the function itself, in the gravel's strength.
static double worst(const struct dig_curve_set *const made, const size_t g, const size_t t,
                    const double factor)
{
    double most = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_s =
            dig_trajectory_time_s(&made->trajectory[0], 0.09, (double)k / (DIG_CURVE_POINTS - 1));
        const double my = approach_moment_Nm(g, t, at_s, factor);
        most            = fmax(most, fabs((double)made->curve[g].mean[0][k] - my));
        most            = fmax(most, fabs((double)made->curve[g].mean[2][k] - 3.0 * my) / 3.0);
    }
    return most / approach_strength(g);
}

TEST(what_is_linear_is_met_everywhere_in_a_cross)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, straight, 0.05, 3);
    static const double          at[][2]          = { { 1.07, 0.0 }, { 0.9, 0.0 },   { 1.0, 3.0 },
                                                      { 1.05, 2.0 }, { 0.93, -1.0 }, { 1.15, 0.0 } };
    static struct dig_covariance of_plain_digs[2] = { { .freedom = 7.0 }, { .freedom = 9.0 } };
    table.cube.set.covariance                     = of_plain_digs;
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        for (size_t t = 0; t < 2; t++) {
            const struct dig_curve_set *const made = make(t, at[i][0], at[i][1]);
            assert_int_equal(made->trajectories, 1);
            assert_null(made->approaches);
            assert_memory_equal(made->covariance, &of_plain_digs[t], sizeof of_plain_digs[t]);
            const struct dig_trajectory dug =
                approach_dug(t, (struct dig_approach){ at[i][0], at[i][1] * DEG });
            assert_memory_equal(&made->trajectory[0], &dug, sizeof dug);
            for (size_t g = 0; g < CUBE_GRAVELS; g++) {
                assert_true(worst(made, g, t, straight(at[i][0], at[i][1] * DEG)) < READ_OFF);
                assert_true(made->packings[g] >= 3);
            }
        }
    }
}

TEST(a_slot_that_is_plain_is_the_table_bit_by_bit)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    const struct dig_curve_set *const made = make(1, 0.0, 0.0);
    for (size_t g = 0; g < CUBE_GRAVELS; g++) {
        assert_memory_equal(&made->curve[g], &table.cube.curve[2 * g + 1],
                            sizeof(struct dig_curve));
        assert_int_equal(made->packings[g], 3);
    }
    assert_memory_equal(&made->trajectory[0], &table.cube.set.trajectory[1],
                        sizeof made->trajectory[0]);
}

TEST(a_product_meets_what_the_axes_do_together)
{
    approach_table_init(&table, CUBE_GRAVELS, 8, product, twisted, 0.05, 3);
    const double factor = twisted(1.1, 4.0 * DEG);
    assert_true(worst(make(0, 1.1, 4.0), 5, 0, factor) < READ_OFF);
    assert_true(fabs(factor - straight(1.1, 4.0 * DEG)) > 0.2);

    // A cross cannot: there the two add up.
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, twisted, 0.05, 3);
    assert_true(fabs(worst(make(0, 1.05, 2.0), 5, 0, straight(1.05, 2.0 * DEG))) < READ_OFF);
}

static double rms(const float y[const DIG_CURVE_POINTS])
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += (double)y[k] * (double)y[k];
    }
    return sqrt(sum / DIG_CURVE_POINTS);
}

// How much the spread of one dig grew beyond the plain one's, that grows with the curve, in the
// plain curve's rms.
static double widened(const struct dig_curve_set *const made, const size_t g, const size_t t)
{
    const struct dig_curve *const plain = &table.cube.curve[2 * g + t];
    const double                  grown = rms(made->curve[g].mean[0]) / rms(plain->mean[0]);
    const double more = pow(rms(made->curve[g].sd[0]), 2.0) - pow(grown * rms(plain->sd[0]), 2.0);
    return sqrt(fmax(more, 0.0)) / rms(plain->mean[0]);
}

TEST(the_spread_grows_by_what_leaving_out_says)
{
    // depth^2 bends by 1 per factor^2: halfway from 1 to 1.15 a straight line is off by .075^2.
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 1e-4, 3);
    const struct dig_curve_set *made = make(0, 1.075, 0.0);
    assert_close(widened(made, 3, 0), 0.075 * 0.075, 0.05 * 0.075 * 0.075);
    assert_close((double)made->curve[3].error[0] * rms(made->curve[3].mean[0]),
                 widened(made, 3, 0) * rms(table.cube.curve[2 * 3].mean[0]), 1e-6);
    assert_close(worst(made, 3, 0, approach_growing(1.075, 0.0) + 0.075 * 0.075), 0.0, 1e-3);
    assert_true(widened(make(0, 1.15, 0.0), 3, 0) < 1e-4);
    assert_true(widened(make(0, 1.0, 2.5), 3, 0) < 3e-4); // attack does not bend

    // What is straight is not widened; nor is what bends less than the means scatter.
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, straight, 1e-4, 3);
    assert_true(widened(make(0, 1.075, 0.0), 3, 0) < 3e-4);
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.3, 3);
    assert_true(widened(make(0, 1.075, 0.0), 3, 0) < 5e-4); // as floats round

    // Dug on one side alone: all of the change may be bent.
    approach_table_init(&table, CUBE_GRAVELS, 1, &cross[3], straight, 1e-4, 3);
    assert_close(widened(make(0, 1.075, 0.0), 3, 0), 0.3 / 4.0, 2e-3);
}

TEST(gravels_that_were_dug_plainly_alone_borrow_the_change)
{
    // Gravels 0 to 5; 6 and 7 borrow. The shape differs a little from gravel to gravel.
    approach_table_init(&table, 6, 4, cross, straight, 1e-4, 3);
    const struct dig_curve_set *made = make(0, 1.1, 0.0);
    const double                off  = worst(made, 7, 0, straight(1.1, 0.0));
    assert_true(off < 0.05);
    assert_true(worst(made, 7, 0, 1.0) > 0.15); // as if it were dug plainly
    assert_true(widened(made, 7, 0) > 0.2 * off && widened(made, 7, 0) < 0.1);
    assert_int_equal(made->packings[7], 3);

    // The nearest count most: of six that lend, the farthest (three axes away) has a twelfth, not a
    // sixth.
    const double before = rms(make(0, 1.15, 0.0)->curve[7].mean[0]);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        table.curve[2 * 3].mean[0][k] *= 1.5F; // gravel 0 at depth 1.15
    }
    const double lent = rms(make(0, 1.15, 0.0)->curve[7].mean[0]);
    const double all  = 0.5 * straight(1.15, 0.0) * rms(table.cube.curve[14].mean[0]);
    assert_close((lent - before) / all, 1.0 / 12.0, 0.04);

    // Nobody has the attack: no gravel can be told.
    const struct dig_approach deep[] = { { 0.85, 0.0 }, { 1.15, 0.0 } };
    approach_table_init(&table, 6, 2, deep, straight, 1e-4, 3);
    made = make(0, 1.1, 3.0);
    for (size_t g = 0; g < CUBE_GRAVELS; g++) {
        assert_int_equal(made->packings[g], 0);
    }
}

static double clamp(const double depth, const double attack_deg, struct dig_approach *const nearest)
{
    const struct dig_approach approach = { depth, attack_deg * DEG };
    return dig_approach_clamp(&table.cube.set, 0, &approach, nearest);
}

TEST(outside_the_hull_the_nearest_place_in_it_counts)
{
    struct dig_approach nearest;
    approach_table_init(&table, CUBE_GRAVELS, 8, product, straight, 0.05, 3);
    assert_close(clamp(1.1, 4.9, &nearest), 0.0, 0.0);
    assert_close(nearest.depth, 1.1, 0.0);
    assert_close(clamp(1.25, 2.0, &nearest), 0.1 * APPROACH_m, 1e-9);
    assert_close(nearest.depth, 1.15, 1e-12);
    assert_close(nearest.attack_rad, 2.0 * DEG, 1e-12);
    assert_close(clamp(1.25, -9.0, &nearest), hypot(0.1 * APPROACH_m, 0.09 * 4.0 * DEG), 1e-9);
    assert_close(nearest.attack_rad, -5.0 * DEG, 1e-12);

    // The cross is a rhombus: its tip is in, the corner of the rectangle around it is not.
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, straight, 0.05, 3);
    const double a = 0.15 * APPROACH_m, b = 0.09 * 5.0 * DEG;
    assert_close(clamp(1.15, 0.0, &nearest), 0.0, 1e-12);
    assert_close(clamp(1.15, 5.0, &nearest), a * b / hypot(a, b), 1e-9);
    assert_close(APPROACH_m * (nearest.depth - 1.0) / a + 0.09 * nearest.attack_rad / b, 1.0, 1e-9);
    assert_true(worst(make(0, nearest.depth, nearest.attack_rad / DEG), 2, 0,
                      straight(nearest.depth, nearest.attack_rad)) < READ_OFF);

    // One axis alone, and none.
    approach_table_init(&table, CUBE_GRAVELS, 1, &cross[3], straight, 0.05, 3);
    assert_close(clamp(1.1, 2.0, &nearest), 0.09 * 2.0 * DEG, 1e-9);
    assert_close(nearest.depth, 1.1, 1e-9);
    assert_close(clamp(0.9, 0.0, &nearest), 0.1 * APPROACH_m, 1e-9);
    assert_close(nearest.depth, 1.0, 1e-12);
    table.cube.set.approaches = NULL;
    assert_close(clamp(1.0, 2.0, &nearest), 0.09 * 2.0 * DEG, 1e-9);
    assert_true(dig_approach_is_plain(&nearest));
}

TEST(of_a_cell_its_entries_alone_are_made_bit_by_bit)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    const struct dig_curve_set *const set    = &table.cube.set;
    struct dig_gravel                 gravel = table.cube.gravel[5];
    struct dig_cell                   cell;
    gravel.value[DIG_AXIS_DENSITY_kgpm3] = 2000.0; // between the fifth and the sixth
    assert_int_equal(dig_cell_find(set, &gravel, 1, &cell), DIG_OK);
    const struct dig_approached_slot slot[] = { { 1, { 1.1, 0.0 }, 1.0, NULL },
                                                { 1, { 1.1, 0.0 }, 1.0, &cell } };
    free(memory);
    memory                                 = malloc(dig_approached_size(set, 2));
    const struct dig_curve_set *const made = dig_approached_make(set, 2, slot, NULL, memory);
    for (size_t e = 0; e < CUBE_GRAVELS; e++) {
        const bool is_of_it = e == 4 || e == 5;
        assert_int_equal(made->packings[2 * e + 1], is_of_it ? made->packings[2 * e] : 0);
        assert_true(!is_of_it || memcmp(&made->curve[2 * e], &made->curve[2 * e + 1],
                                        sizeof made->curve[0]) == 0);
    }
}

TEST(a_deeper_dig_is_matched_and_predicted_by_the_table_of_its_depth)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    const struct dig_approach   approach = { 1.1, 1.0 * DEG };
    const struct dig_trajectory dug      = approach_dug(0, approach);
    struct dig_curve            truth;
    approach_curve(2, 0, &dug, approach_growing(1.1, 1.0 * DEG), 0.05, &truth);
    struct dig_observation seen = { .dig_count = 1, .first = 0.0, .last = 1.0 };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        seen.moment_Nm[k] = (double)truth.mean[0][k];
    }
    const struct dig_approached_slot slot[] = { { 0, approach, 0.0, NULL },
                                                { 1, approach, 0.0, NULL } };
    free(memory);
    memory = malloc(dig_approached_size(&table.cube.set, 2));
    const struct dig_curve_set *const made =
        dig_approached_make(&table.cube.set, 2, slot, NULL, memory);
    struct dig_match plain, deep;
    assert_int_equal(dig_match_nearest(&table.cube.set, 1, &seen, 3.0, &plain), DIG_OK);
    assert_int_equal(dig_match_nearest(made, 1, &seen, 3.0, &deep), DIG_OK);
    assert_int_equal(deep.nearest, 2);
    assert_true(deep.distance < 0.01);
    assert_true(plain.nearest != 2 || plain.distance > 0.1); // too deep looks like too strong

    struct dig_curve predicted, nominal;
    assert_int_equal(dig_predict_curve(made, &deep, 1, &predicted), DIG_OK);
    assert_int_equal(dig_predict_curve(&table.cube.set, &deep, 1, &nominal), DIG_OK);
    approach_curve(2, 1, &made->trajectory[1], approach_growing(1.1, 1.0 * DEG), 0.05, &truth);
    double off = 0.0, nominal_off = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        off += pow((double)predicted.mean[0][k] - (double)truth.mean[0][k], 2.0);
        nominal_off += pow((double)nominal.mean[0][k] - (double)truth.mean[0][k], 2.0);
    }
    assert_true(sqrt(off) < 0.1 * sqrt(nominal_off));
}

TEST(a_forecast_as_dug_lies_over_the_plain_path_where_its_legs_do)
{
    approach_table_init(&table, CUBE_GRAVELS, 4, cross, straight, 1e-4, 3);
    const struct dig_approach         approach = { 1.15, 0.0 };
    const struct dig_curve_set *const set      = &table.cube.set;
    const struct dig_match match = { .valid = true, .gravel = table.cube.gravel[4], .nearest = 4 };
    struct dig_expected    expected;
    free(memory);
    memory = malloc(dig_approached_size(set, 1));
    dig_forecast_as_dug(set, 10.0, &match, 0, &approach, NULL, memory, &expected);
    assert_true(expected.valid && !expected.off_table);
    double highest_Nm = 0.0; // of the mean: a dig that hardly scatters peaks there
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        highest_Nm = fmax(highest_Nm, (double)expected.curve.mean[0][k]);
    }
    assert_close(expected.peak_Nm, 1e4 * highest_Nm, 1e-2 * expected.peak_Nm);
    dig_forecast_along_plain(set, 0, approach.depth, &expected);
    const struct dig_trajectory dug   = approach_dug(0, approach);
    const struct dig_trajectory plain = approach_dug(0, dig_approach_plain());
    for (int k = 60; k < DIG_CURVE_POINTS; k += 20) { // behind the first leg: at equal times
        const double t_s = dig_trajectory_time_s(&plain, 0.09, k / (DIG_CURVE_POINTS - 1.0));
        assert_true(t_s > dug.phase[0].duration_s);
        assert_close((double)expected.curve.mean[0][k],
                     approach_moment_Nm(4, 0, t_s, straight(1.15, 0.0)),
                     READ_OFF * approach_strength(4));
    }
    // At the plain start it is under way already.
    assert_true((double)expected.curve.mean[0][0] > 0.05);
}

TESTS_WITH(NULL, tear_down)
