#include "closed_loop/search/unlisted.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 7 };

static const struct dig_gravel   gravel = { { 0.6, 0.55, 2500 } };
static struct dig_batch          batch;
static struct dig_measured       measured[DIGS];
static struct dig_model_unlisted share;

// Six simple digs with a dip of these magnitudes, and one real one with the first's; corrected
// beside the gravel that they are of. Returns the root mean square of the share along a trajectory.
static double correct(const double magnitude[2], const enum made_trajectory along)
{
    const enum dig_effect_id dip  = DIG_EFFECT_UNLISTED;
    uint64_t                 seed = 11;
    double                   place[DIG_AXES];
    for (size_t i = 0; i < DIGS; i++) {
        const bool simple = i + 1 < DIGS;
        measured[i]       = made_dig(&gravel, simple ? MADE_SIMPLE_A : MADE_ACTUAL, 1, &dip,
                                     &magnitude[simple ? i % 2 : 0], &seed);
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    struct dig_fitted plain = { .hypothesis = { .effects = 0 } };
    dig_response_surface_place(world.surface, &gravel, place);
    memcpy(plain.number, place, sizeof place);
    for (size_t g = 0; g < batch.groups; g++) {
        plain.noise[g] = 0.1;
    }
    dig_unlisted_correct(&batch, &plain, &share);
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += pow((double)share.share[along][DIG_CHANNEL_MY_Nm][k], 2.0) / DIG_CURVE_POINTS;
    }
    return sqrt(sum);
}

TEST(what_all_digs_show_is_corrected)
{
    double dip = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        dip += pow(made_effect(DIG_EFFECT_UNLISTED, MADE_SIMPLE_A, DIG_CHANNEL_MY_Nm,
                               (double)k / (DIG_CURVE_POINTS - 1)),
                   2.0) /
               DIG_CURVE_POINTS;
    }
    const double same[2] = { 1.0, 1.0 };
    assert_close(correct(same, MADE_SIMPLE_A) / sqrt(dip), 1.0, 0.25);
    assert_true(correct(same, MADE_ACTUAL) > 0.3 * sqrt(dip));
}

// Large in every dig and different in each: the mean of the others makes each worse, and of the
// real dig alone nobody knows.
TEST(digs_that_differ_from_each_other_are_left_alone)
{
    const double against[2] = { 2.0, -2.0 };
    assert_close(correct(against, MADE_SIMPLE_A), 0.0, 1e-9);
    assert_close(correct(against, MADE_ACTUAL), 0.0, 1e-9);
}

TESTS_WITH(world_setup, world_teardown)
