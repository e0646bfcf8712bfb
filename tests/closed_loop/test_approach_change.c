// Tests for closed_loop/model/approach_change.c, on a table whose curves are a known function of
// depth.

#include "closed_loop/model/approach_change.h"
#include "tests/approach_table.h"

#include <math.h>

// Dug at .8 and 1.2 by all gravels; a dig resists as the square of its depth.
static const struct dig_approach way[] = { { 0.8, 0.0 }, { 1.2, 0.0 } };

enum { CORNER = 60 }; // points behind the first leg of either trajectory

static struct approach_table table;

static int set_up(void **state)
{
    (void)state;
    approach_table_init(&table, CUBE_GRAVELS, 2, way, approach_growing, 0.1, 3);
    return 0;
}

// Behind the first leg all depths are at one place at one time.
TEST_WITH(a_deeper_dig_adds_what_the_table_says, set_up, NULL)
{
    const struct dig_curve_set *const set = &table.cube.set;
    struct dig_added                  added;
    for (size_t t = 0; t < 2; t++) {
        for (size_t g = 0; g < CUBE_GRAVELS; g++) {
            const struct dig_curve *const plain = &set->curve[2 * g + t];
            assert_int_equal(dig_approach_added(set, t, &set->gravel[g], &way[1], NULL, &added),
                             DIG_OK);
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                for (size_t k = CORNER; k < DIG_CURVE_POINTS; k++) {
                    assert_close(added.value[c][k], 0.44 * (double)plain->mean[c][k],
                                 0.01 * fabs((double)plain->mean[c][CORNER]));
                }
            }
            // Beyond what was dug, as at the end of it.
            struct dig_added          beyond;
            const struct dig_approach deep  = { .depth = 2.0 };
            const struct dig_approach level = dig_approach_plain();
            assert_int_equal(dig_approach_added(set, t, &set->gravel[g], &deep, NULL, &beyond),
                             DIG_OK);
            assert_memory_equal(&beyond, &added, sizeof added);
            assert_int_equal(dig_approach_added(set, t, &set->gravel[g], &level, NULL, &added),
                             DIG_OK);
            assert_close(added.value[0][CORNER], 0.0, 1e-6);
        }
    }
}

// A tenth deeper over half its way: there it resists as a dig a tenth deeper, by half of which it
// may be off.
TEST_WITH(a_dig_that_leaves_its_trajectory_is_as_deep_as_it_is, set_up, NULL)
{
    const struct dig_curve_set *const set   = &table.cube.set;
    const struct dig_approach         level = dig_approach_plain();
    const struct dig_curve *const     plain = &set->curve[2 * 3];
    double                            deeper[DIG_CURVE_POINTS];
    struct dig_added                  added;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        deeper[k] = k < 150 ? 0.0 : 0.1;
    }
    assert_int_equal(dig_approach_added(set, 0, &set->gravel[3], &level, deeper, &added), DIG_OK);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = CORNER; k < DIG_CURVE_POINTS; k++) {
            const double by = deeper[k] * (1.44 - 0.64) / 0.4 * (double)plain->mean[c][k];
            assert_close(added.value[c][k], by, 0.01 * fabs((double)plain->mean[c][CORNER]));
            assert_close(added.error[c][k], 0.5 * added.value[c][k], 1e-12);
        }
    }
    assert_true(added.noise > 0.0);
}

// Half as far as it was dug adds half as much, and a turned bucket follows the same path.
TEST(a_turned_bucket_adds_what_the_table_says)
{
    static const struct dig_approach  turned[] = { { 1.0, -0.2 }, { 1.0, 0.2 } };
    static const struct dig_approach  half     = { 1.0, 0.1 };
    const struct dig_curve_set *const set      = &table.cube.set;
    struct dig_added                  added;
    approach_table_init(&table, CUBE_GRAVELS, 2, turned, approach_growing, 0.1, 3);
    for (size_t g = 0; g < CUBE_GRAVELS; g++) {
        const struct dig_curve *const plain = &set->curve[2 * g];
        assert_int_equal(dig_approach_added(set, 0, &set->gravel[g], &half, NULL, &added), DIG_OK);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_close(added.value[c][k], -0.15 * (double)plain->mean[c][k],
                             0.01 * fabs((double)plain->mean[c][CORNER]));
            }
        }
        // Half of the mean of three beds, less half of that of three others.
        assert_close(added.noise, 2.0 * 0.25 / 3.0, 1e-9);
    }
}

// 1 sigma of depths that are as likely between .8 and 1.2; the same for every gravel here.
TEST_WITH(the_change_is_one_sigma_of_the_depths, set_up, NULL)
{
    const struct dig_curve_set *const set = &table.cube.set;
    for (size_t t = 0; t < 2; t++) {
        const struct dig_curve *const curve = &set->curve[2 * 3 + t];
        double                        plain[DIG_FEATURES];
        double                        amplitude[DIG_FORCE_CHANNELS];
        double                        own[DIG_FEATURES];
        dig_features_of_table(curve->mean, plain);
        dig_features_amplitude(plain, NULL, amplitude);
        assert_int_equal(dig_depth_change(set, t, &set->gravel[3], own), DIG_OK);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const struct dig_bin points = dig_feature_bin(f % DIG_FEATURE_BINS);
            if (points.from >= CORNER) {
                const double whole = (1.44 - 0.64) * plain[f] / amplitude[f / DIG_FEATURE_BINS];
                assert_close(own[f], whole / sqrt(12.0), 0.005);
            }
        }
    }
}

TEST_WITH(of_a_gravel_that_the_table_lacks_the_change_is_that_of_others, set_up, NULL)
{
    const struct dig_gravel lacking = table.cube.gravel[3];
    double                  own[DIG_FEATURES];
    double                  others[DIG_FEATURES];
    double                  mean[DIG_FEATURES];
    assert_int_equal(dig_depth_change(&table.cube.set, 0, &lacking, own), DIG_OK);
    table.cube.packings[2 * 3] = 0;
    assert_int_equal(dig_depth_change(&table.cube.set, 0, &lacking, others), DIG_OK);
    for (size_t b = 3; b < DIG_FEATURE_BINS; b++) { // behind the first leg
        assert_close(others[b], own[b], 0.05);
    }
    assert_true(own[4] > 0.1);
    assert_int_equal(dig_depth_change(&table.cube.set, 0, NULL, mean), DIG_OK);
    assert_memory_equal(mean, others, sizeof mean);
}

TEST_WITH(a_table_of_one_depth_has_none, set_up, NULL)
{
    double           change[DIG_FEATURES] = { 1.0 };
    struct dig_added added;
    table.cube.set.approaches = NULL;
    assert_int_equal(dig_depth_change(&table.cube.set, 0, &table.cube.gravel[0], change), DIG_OK);
    assert_close(change[0], 0.0, 0.0);
    assert_int_equal(
        dig_approach_added(&table.cube.set, 0, &table.cube.gravel[0], &way[1], NULL, &added),
        DIG_OK);
    assert_close(added.value[0][200], 0.0, 0.0);
}
