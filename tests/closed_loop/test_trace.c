#include "closed_loop/verdict/trace.h"

#include "closed_loop/recordings/lateness.h"
#include "closed_loop/verdict/residuals.h"

#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGS = 8, FEW = 3 };

static struct dig_measured measured[DIGS];

// Four simple and four real digs; the first identifies, the last two real ones are held out.
static void campaign_of(const struct dig_gravel *const gravel, const size_t effects,
                        const enum dig_effect_id effect, const double magnitude, uint64_t seed)
{
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] = made_dig(gravel, i % 2 == 0 ? MADE_SIMPLE_A : MADE_ACTUAL, effects, &effect,
                               &magnitude, &seed);
        measured[i].order = i;
        measured[i].use   = i == 0 ? DIG_USE_IDENTIFY : DIG_USE_FIT;
    }
    measured[5].use = DIG_USE_HOLDOUT;
    measured[7].use = DIG_USE_HOLDOUT;
}

static void dig_campaign(const size_t effects, const enum dig_effect_id effect,
                         const double magnitude, const uint64_t seed)
{
    campaign_of(&(struct dig_gravel){ { 0.6, 0.55, 2500 } }, effects, effect, magnitude, seed);
}

// Of so many campaigns drawn anew.
static size_t bootstraps = 24;

static enum dig_status run(struct dig_trace *const trace, struct dig_error *const error)
{
    struct dig_trace_settings settings = dig_trace_settings_default();
    settings.bootstraps                = bootstraps;
    return dig_trace_run(world.set, NULL, world.effects, &settings, NULL, DIGS, measured, trace,
                         error);
}

static struct dig_trace trace; // of the campaign traced last

static void trace_campaign(void)
{
    dig_trace_finish(&trace);
    assert_int_equal(run(&trace, NULL), DIG_OK);
}

static int tear_down(void **state)
{
    dig_trace_finish(&trace);
    return world_teardown(state);
}

TEST(adding_the_effect_makes_the_holdout_better)
{
    dig_campaign(1, DIG_EFFECT_LAYERING, 0.8, 31);
    trace_campaign();
    assert_true(trace.significant);
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_LAYERING);
    assert_int_equal(trace.seen_in[0], DIG_PART_SOIL);
    assert_int_equal(trace.holdouts, 2);
    assert_true(trace.applied);
    assert_true(trace.after.value < 0.7 * trace.before.value);
    assert_true(trace.after.low <= trace.after.value && trace.after.value <= trace.after.high);
    // What is left is no more than two sigma of what one dig scatters.
    assert_true(trace.after.value < 2.0 * trace.noise_floor);
    assert_true(isnan(trace.residual[DIG_PART_AIR]));
    assert_true(trace.candidate[0].as.effect == DIG_EFFECT_LAYERING);
}

// A force sensor's filter, over the dig's own time.
static void lag(const double lag_s, struct dig_measured *const dig)
{
    const struct dig_trajectory *const t       = &world.set->trajectory[dig->trajectory];
    const double                       tooth_m = world.set->tooth_m;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double before_s = 0.0;
        double read     = dig->value[c][0];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double at_s =
                dig_trajectory_time_s(t, tooth_m, (double)k / (DIG_CURVE_POINTS - 1)) / dig->pace;
            read += (dig->value[c][k] - read) * (1.0 - exp(-(at_s - before_s) / lag_s));
            dig->value[c][k] = read;
            before_s         = at_s;
        }
    }
    dig_lateness_rate(t, tooth_m, dig, dig->rate);
}

TEST(forces_that_lag_are_late_and_no_soil)
{
    const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
    for (uint64_t seed = 41; seed < (test_is_quick() ? 42 : 44); seed++) {
        dig_campaign(0, DIG_EFFECT_COHESION, 0.0, seed);
        for (size_t i = 0; i < DIGS; i++) {
            lag(0.1, &measured[i]);
        }
        trace_campaign();
        assert_int_equal(trace.effects, 1);
        assert_int_equal(trace.effect[0].effect, DIG_EFFECT_SENSOR_DELAY);
        assert_string_equal(trace.effect[0].parameter[0].name, "delay_s");
        assert_close(trace.effect[0].parameter[0].value, 0.1, 0.02);
        assert_true(trace.effect[0].parameter[0].high - trace.effect[0].parameter[0].low < 0.05);
        for (int a = 0; a < DIG_AXES; a++) {
            assert_true(trace.low.value[a] <= gravel.value[a] &&
                        gravel.value[a] <= trace.high.value[a]);
        }
        assert_true(trace.after.value < trace.before.value);
    }
}

TEST(nothing_is_late_in_forces_that_are_not)
{
    dig_campaign(0, DIG_EFFECT_COHESION, 0.0, 45);
    for (size_t i = 0; i < DIGS; i++) {
        lag(1e-6, &measured[i]);
    }
    trace_campaign();
    assert_int_equal(trace.effects, 0);
    bool asked = false;
    for (size_t i = 0; i < trace.candidates; i++) {
        asked = asked || trace.candidate[i].as.effect == DIG_EFFECT_SENSOR_DELAY;
    }
    assert_true(asked);
}

// Of two holdouts: the root of the mean square of their own errors, as near as they are of one
// size.
TEST(what_is_left_is_told_dig_by_dig)
{
    dig_campaign(1, DIG_EFFECT_COHESION, 0.8, 31);
    bootstraps = 100;
    trace_campaign();
    bootstraps = 24;
    assert_int_equal(trace.effects, 1);
    const struct dig_residuals *const r = trace.residuals;
    assert_non_null(r);
    assert_int_equal(trace.judged.digs, DIGS);
    assert_ptr_equal(trace.judged.measured, measured);
    double before = 0.0;
    double after  = 0.0;
    for (size_t i = 5; i < DIGS; i += 2) {
        for (int p = DIG_PART_SOIL; p < DIG_TRACE_PHASES; p++) {
            before += pow(r->dig[i].before[p][DIG_CHANNEL_MY_Nm].relative, 2.0) / 2.0;
            after += pow(r->dig[i].after[p][DIG_CHANNEL_MY_Nm].relative, 2.0) / 2.0;
        }
        assert_true(isnan(r->dig[i].air_sigmas));
    }
    assert_close(sqrt(before) / trace.before.value, 1.0, 0.02);
    assert_close(sqrt(after) / trace.after.value, 1.0, 0.02);
    // The digs say where along the path cohesion shows: the sine that it is made of falls from its
    // first quarter to its third.
    assert_true(r->known[DIG_CHANNEL_MY_Nm] && r->known[DIG_CHANNEL_FZ_N]);
    const struct dig_trend *const path = &r->trend[DIG_CHANNEL_MY_Nm][DIG_REGRESSOR_PATH];
    assert_true(path->slope < 0.0 && path->correlation < -0.3);
    assert_int_equal(path->bin[0].digs, DIGS - 2);
    assert_true(isnan(r->trend[DIG_CHANNEL_MY_Nm][DIG_REGRESSOR_PASS].slope));
}

TEST(without_an_effect_before_and_after_are_the_same)
{
    dig_campaign(0, DIG_EFFECT_LAYERING, 0.0, 32);
    trace_campaign();
    assert_false(trace.significant);
    assert_int_equal(trace.effects, 0);
    assert_close(trace.after.value, trace.before.value, 1e-12);
    assert_false(trace.applied || trace.beyond);
    assert_memory_equal(&trace.gravel_before, &trace.gravel, sizeof trace.gravel);
    assert_memory_equal(&trace.low_before, &trace.low, sizeof trace.low);
    assert_memory_equal(&trace.high_before, &trace.high, sizeof trace.high);
    assert_false(trace.unlisted.any);
}

// It is no effect, and the prediction is made with it all the same.
TEST(a_gravel_beyond_the_grid_is_said_to_be_that)
{
    const struct dig_gravel beyond = { { 0.25, 0.05, 1200.0 } };
    campaign_of(&beyond, 0, DIG_EFFECT_LAYERING, 0.0, 35);
    trace_campaign();
    assert_true(trace.beyond && trace.applied);
    assert_false(trace.significant);
    assert_int_equal(trace.effects, 0);
    assert_true(trace.after.value < trace.before.value);
}

TEST(what_has_no_name_is_corrected_all_the_same)
{
    dig_campaign(1, DIG_EFFECT_UNLISTED, 1.2, 33);
    trace_campaign();
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_true(trace.unlisted.any);
    assert_true(trace.unlisted.depends_on[0] != '\0');
    assert_true(trace.effect[0].probability > 0.95);
    assert_true(trace.after.value < 0.7 * trace.before.value);
}

// Without a name as with one: no more than even odds are claimed for what the moment hardly shows.
TEST(what_the_moment_does_not_show_is_not_claimed)
{
    static struct dig_measured in_forces[DIGS];
    dig_campaign(1, DIG_EFFECT_UNLISTED, 1.2, 33);
    memcpy(in_forces, measured, sizeof in_forces);
    dig_campaign(0, DIG_EFFECT_UNLISTED, 0.0, 33);
    for (size_t i = 0; i < DIGS; i++) {
        memcpy(in_forces[i].value[DIG_CHANNEL_MY_Nm], measured[i].value[DIG_CHANNEL_MY_Nm],
               sizeof in_forces[i].value[DIG_CHANNEL_MY_Nm]);
    }
    memcpy(measured, in_forces, sizeof in_forces);
    trace_campaign();
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_true(trace.significant && trace.p_complete < 0.01);
    assert_true(trace.effect[0].probability <= 0.5);
}

// What the machine adds is taken off the digs and put back on the prediction.
TEST(the_machines_share_is_the_machines)
{
    struct dig_trace plain, shifted;
    dig_campaign(0, DIG_EFFECT_LAYERING, 0.0, 34);
    assert_int_equal(run(&plain, NULL), DIG_OK);
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].machine[DIG_CHANNEL_MY_Nm][k] = 0.3;
            measured[i].value[DIG_CHANNEL_MY_Nm][k] += 0.3;
        }
    }
    assert_int_equal(run(&shifted, NULL), DIG_OK);
    assert_false(shifted.significant);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(shifted.gravel.value[a] / plain.gravel.value[a], 1.0, 0.05);
    }
    const double moved = shifted.judged.curves[5].after.value[DIG_CHANNEL_MY_Nm][100] -
                         plain.judged.curves[5].after.value[DIG_CHANNEL_MY_Nm][100];
    assert_close(moved, 0.3, 0.05);
    dig_trace_finish(&plain);
    dig_trace_finish(&shifted);
}

TEST(too_few_digs_are_refused_and_nothing_is_written)
{
    struct dig_trace none  = { .holdouts = 42 };
    struct dig_error error = { "" };
    dig_campaign(0, DIG_EFFECT_LAYERING, 0.0, 35);
    for (size_t i = 1; i < DIGS; i++) {
        measured[i].use = DIG_USE_HOLDOUT;
    }
    assert_refused(run(&none, &error), error, DIG_EINVAL, "expected two or more");
    measured[1].use        = DIG_USE_FIT;
    measured[1].trajectory = 7;
    assert_int_equal(run(&none, &error), DIG_EINVAL);
    assert_int_equal(none.holdouts, 42);
}

TEST(another_scenes_effects_are_refused)
{
    struct dig_trace none  = { .holdouts = 42 };
    struct dig_error error = { "" };
    dig_campaign(0, DIG_EFFECT_LAYERING, 0.0, 36);
    world.effects->scene_hash[0] ^= 1;
    assert_int_equal(run(&none, &error), DIG_EINVAL);
    world.effects->scene_hash[0] ^= 1;
    assert_contains(error.text, "another scene");
    assert_int_equal(none.holdouts, 42);
}

// A dig held out decides nothing: another holdout, the same verdict and gravel.
TEST(the_holdout_is_for_the_error_alone)
{
    struct dig_trace a, b;
    dig_campaign(1, DIG_EFFECT_LAYERING, 0.6, 37);
    assert_int_equal(run(&a, NULL), DIG_OK);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        measured[7].value[DIG_CHANNEL_MY_Nm][k] *= 3.0;
    }
    assert_int_equal(run(&b, NULL), DIG_OK);
    assert_close(a.p_complete, b.p_complete, 0.0);
    assert_memory_equal(&a.gravel, &b.gravel, sizeof a.gravel);
    assert_true(b.after.value > a.after.value);
    dig_trace_finish(&a);
    dig_trace_finish(&b);
}

// No effect competes there, not even wear: that digs are like none of the table is found all the
// same.
TEST(without_a_table_of_effects_strange_digs_are_found)
{
    struct dig_trace_settings settings = dig_trace_settings_default();
    struct dig_error          error    = { "" };
    settings.bootstraps                = 24;
    dig_campaign(0, DIG_EFFECT_UNLISTED, 0.0, 17);
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double *const v = measured[i].value[c];
            for (size_t k = 0; k < DIG_CURVE_POINTS / 2; k++) {
                const double other          = v[DIG_CURVE_POINTS - 1 - k];
                v[DIG_CURVE_POINTS - 1 - k] = v[k];
                v[k]                        = other;
            }
        }
    }
    dig_trace_finish(&trace);
    assert_int_equal(
        dig_trace_run(world.set, NULL, NULL, &settings, NULL, FEW, measured, &trace, &error),
        DIG_OK);
    assert_true(trace.significant);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
}

TESTS_WITH(world_setup, tear_down)
