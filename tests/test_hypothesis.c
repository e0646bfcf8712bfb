#include "closed_loop/hypothesis.h"

#include "tests/model_front.h"
#include "tests/world_fixture.h"

#include <string.h>

enum { DIGS = 4, WORLDS = 10, MANY = 400 };

// What two DEM codes may differ by stands in the noise of every group:
// docs/numerics/closed_loop.md.
static const double discrepancy = 0.05;

static struct dig_measured measured[DIGS];

// Plain digs, every force times so much.
static void dig(const struct dig_gravel *const gravel, const double larger, uint64_t seed)
{
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] = made_dig(gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                measured[i].value[c][k] *= larger;
            }
        }
    }
}

static void true_features(const struct dig_gravel *const gravel, double feature[DIG_FEATURES])
{
    static double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    uint64_t      seed = 77;
    memset(mean, 0, sizeof mean);
    for (int i = 0; i < MANY; i++) {
        const struct dig_measured one = made_dig(gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                mean[c][k] += one.value[c][k] / MANY;
            }
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])mean, feature);
}

// Mean square of what tables of other packings say of this gravel beside the truth, in the group's
// units: by making the tables.
static double made_variance(const struct dig_batch_group *const group,
                            const struct dig_gravel *const      gravel)
{
    double truth[DIG_FEATURES];
    double y_true[DIG_FEATURES];
    double sum = 0.0;
    true_features(gravel, truth);
    dig_batch_whiten(group, truth, y_true);
    for (uint64_t w = 0; w < WORLDS; w++) {
        struct made_world other = made_world(1000 + w);
        double            place[DIG_AXES], feature[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double            y[DIG_FEATURES];
        dig_surface_place(other.surface, gravel, place);
        dig_surface_features(other.surface, MADE_ACTUAL, place, feature, size);
        dig_batch_whiten(group, feature, y);
        for (size_t k = 0; k < group->features; k++) {
            sum += (y[k] - y_true[k]) * (y[k] - y_true[k]) / (double)group->features / WORLDS;
        }
        made_world_finish(&other);
    }
    return sum;
}

// The unit of a group is what its digs scatter by. Beside digs three times as large as any the
// table holds, what the table does not know counts for so much less.
static void the_tables_error_counts_for_less_beside_larger_digs(void **state)
{
    (void)state;
    static const struct dig_hypothesis plain                         = { .effects = 0 };
    static const bool                  take[DIGS]                    = { true, true, true, true };
    const struct dig_gravel            gravel                        = { { 0.6, 0.55, 3900 } };
    const double                       start[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    for (double larger = 1.0; larger < 4.0; larger += 2.0) {
        static struct dig_batch batch;
        struct dig_fitted       fitted;
        double                  place[DIG_AXES];
        dig(&gravel, larger, 9);
        dig_surface_place(world.surface, &gravel, place);
        assert_int_equal(
            dig_batch_make(world.surface, world.scatter, DIGS, measured, take, place, &batch),
            DIG_OK);
        dig_hypothesis_fit(&batch, soil, &plain, start, true, &fitted);
        const struct dig_gravel found = dig_surface_gravel(world.surface, fitted.number);
        const double            truth = made_variance(&batch.group[0], &found);
        const double            said  = fitted.noise[0] - discrepancy;
        assert_true(said > 0.5 * truth && said < 2.0 * truth);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tables_error_counts_for_less_beside_larger_digs),
    };
    return cmocka_run_group_tests_name("hypothesis", tests, world_setup, world_teardown);
}
