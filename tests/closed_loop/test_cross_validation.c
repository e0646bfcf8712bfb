#include "closed_loop/search/cross_validation.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 7 };

static struct dig_measured     measured[DIGS];
static struct dig_batch        batch;
static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };

// Six digs of one trajectory and one of the other at this place.
static void dig_with_lone(const size_t lone, const double layer, uint64_t seed)
{
    static const enum dig_effect_id layering = DIG_EFFECT_LAYERING;
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] =
            made_dig(&gravel, i == lone ? MADE_ACTUAL : MADE_SIMPLE_A, 1, &layering, &layer, &seed);
        measured[i].order = i;
    }
    batch_digs(DIGS, measured, &gravel, &batch);
}

static void dig_with(const double layer, const uint64_t seed)
{
    dig_with_lone(2, layer, seed);
}

static const struct dig_fitted *fit_of(const enum dig_effect_id effect, const size_t effects)
{
    static struct dig_fitted    fitted[2];
    const struct dig_hypothesis hypothesis = { .effects = effects, .effect = { effect } };
    const double                middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    dig_hypothesis_fit(&batch, &hypothesis, middle, DIG_FIT_THOROUGH, &fitted[effects]);
    return &fitted[effects];
}

static double gain_of(const enum dig_effect_id effect)
{
    return dig_cross_validation_gain(&batch, fit_of(effect, 0), fit_of(effect, 1));
}

TEST(what_is_there_predicts_the_digs_left_out)
{
    dig_with(0.8, 3);
    assert_true(gain_of(DIG_EFFECT_LAYERING) > 20.0);
}

// Fitted to digs without an effect, a trend explains their scatter and predicts none: over twelve
// campaigns it takes nothing off what was left out.
TEST(what_is_not_there_predicts_nothing)
{
    double sum = 0.0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        dig_with(0.0, 100 + seed);
        sum += gain_of(DIG_EFFECT_WEAR);
    }
    assert_true(sum < 0.0);
}

// Two digs, of which one has the moment alone: adhesion is not in it, so that any magnitude fits it
// and the other dig is predicted by chance. Over a dozen campaigns what is there must still count
// for itself; predicted as if the moment told all, it counts against.
TEST(others_that_tell_nothing_of_an_effect_do_not_count_against_it)
{
    static const enum dig_effect_id adhesion = DIG_EFFECT_ADHESION;
    static const double             size     = 0.5;
    double                          sum      = 0.0;
    for (uint64_t campaign = 1; campaign <= 12; campaign++) {
        uint64_t seed = 1000 * campaign;
        measured[0]   = made_dig(&gravel, MADE_SIMPLE_A, 1, &adhesion, &size, &seed);
        measured[1]   = made_dig(&gravel, MADE_ACTUAL, 1, &adhesion, &size, &seed);
        measured[1].measured[DIG_CHANNEL_FX_N] = false;
        measured[1].measured[DIG_CHANNEL_FZ_N] = false;
        batch_digs(2, measured, &gravel, &batch);
        sum += gain_of(adhesion);
    }
    print_message("gain of twelve campaigns %.1f\n", sum);
    assert_true(sum > 20.0);
}

// A trend needs four digs: of four none can be left out.
TEST(what_cannot_be_fitted_to_the_others_counts_nothing)
{
    dig_with(0.0, 5);
    batch_digs(4, measured, &gravel, &batch);
    assert_close(gain_of(DIG_EFFECT_WEAR), 0.0, 0.0);
}

// The only real dig takes its trajectory along; the others keep their numbers, means are theirs.
static void expect_the_others(const size_t lone)
{
    static struct dig_batch others;
    dig_with_lone(lone, 0.0, 9);
    for (size_t out = 0; out < DIGS; out++) {
        dig_batch_leave_out(&batch, out, &others);
        assert_int_equal(others.digs, DIGS - 1);
        assert_int_equal(others.groups, out == lone ? 1 : 2);
        for (size_t i = 0; i < others.digs; i++) {
            const struct dig_batch_dig *const was = &batch.dig[i < out ? i : i + 1];
            assert_int_equal(others.dig[i].measured, was->measured);
            assert_memory_equal(others.dig[i].y, was->y, sizeof was->y);
            assert_int_equal(others.group[others.dig[i].group].trajectory,
                             batch.group[was->group].trajectory);
        }
        for (size_t g = 0; g < others.groups; g++) {
            double sum = 0.0;
            size_t n   = 0;
            for (size_t i = 0; i < others.digs; i++) {
                n += others.dig[i].group == g ? 1 : 0;
                sum += others.dig[i].group == g ? others.dig[i].y[0] : 0.0;
            }
            assert_int_equal(others.group[g].digs, n);
            assert_close(others.group[g].mean[0], sum / (double)n, 1e-12);
        }
    }
}

TEST(a_dig_left_out_leaves_the_others_as_they_are)
{
    expect_the_others(2);
    expect_the_others(0); // of the first trajectory: the second becomes the first
}

// What is open beside the soil is fitted to the others and told of the dig left out, so that the
// gain is that of digs without it.
TEST(what_is_open_is_told_of_the_dig_left_out)
{
    static struct dig_steps steps;
    const double            off[] = { -3.0 };
    dig_with(0.8, 3);
    const double gain = gain_of(DIG_EFFECT_LAYERING);
    steps             = (struct dig_steps){ .steps = 1 };
    for (size_t g = 0; g < batch.groups; g++) {
        const struct dig_group *const group = &batch.group[g];
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            steps.of[0][group->trajectory][f] =
                (f % 2 == 0 ? 0.1 : -0.1) * group->amplitude[f / DIG_FEATURE_BINS];
        }
    }
    batch.steps = &steps;
    dig_steps_settle(&batch, off);
    steps.middle[0]     = 2.5;
    const double closed = gain_of(DIG_EFFECT_LAYERING);
    batch.steps         = &steps;
    const double open   = gain_of(DIG_EFFECT_LAYERING);
    print_message("gain %.1f, open %.1f, closed %.1f\n", gain, open, closed);
    assert_true(fabs(closed / gain - 1.0) > 0.3);
    assert_true(fabs(open / gain - 1.0) < 0.1);
}

TESTS_WITH(world_setup, world_teardown)
