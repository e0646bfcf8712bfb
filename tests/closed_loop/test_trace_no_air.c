// Tests for a campaign without free air: closed_loop/verdict/trace_verdict.c, trace_advice.c

#include "closed_loop/verdict/trace_work.h"
#include "tests/closed_loop/world_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGS = 4 };

static struct dig_measured        measured[DIGS];
static struct dig_batch           batch;
static struct dig_search          search;
static struct dig_machine_finding air;

// The first digs of four with a layer, along two trajectories in turn, and both hypotheses fitted.
static struct dig_trace_work work(const size_t digs)
{
    static const enum dig_effect_id    effect = DIG_EFFECT_LAYERING;
    static const struct dig_gravel     gravel = { { 0.6, 0.55, 2500 } };
    static const struct dig_hypothesis layer  = { .effects = 1, .effect = { DIG_EFFECT_LAYERING } };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    const double                       magnitude                      = 0.8;
    uint64_t                           seed                           = 61;
    dig_in_turn(digs, &gravel, 1, &effect, &magnitude, &seed, measured);
    batch_digs(digs, measured, &gravel, &batch);
    memset(&search, 0, sizeof search);
    search.significant = true;
    search.plain       = fit_plain(&batch);
    dig_hypothesis_fit(&batch, &layer, middle, DIG_FIT_THOROUGH, &search.chosen);
    air = (struct dig_machine_finding){ .p_complete = 1.0, .no_air = true };
    return (struct dig_trace_work){
        .surface = world.surface, .soil = soil, .batch = &batch, .search = &search, .air = &air
    };
}

static bool is_confirmed(struct dig_trace_work *const w)
{
    w->confirmed = false;
    dig_trace_confirm_without_air(w);
    return w->confirmed;
}

TEST(what_predicts_the_digs_left_out_is_confirmed)
{
    struct dig_trace_work w = work(4);
    assert_true(is_confirmed(&w));
    // One that says of every dig what no effect says predicts none better.
    search.chosen = search.plain;
    assert_false(is_confirmed(&w));
    // With free air it is not asked.
    air.no_air = false;
    assert_true(is_confirmed(&w));
    air.no_air         = true;
    search.significant = false;
    assert_true(is_confirmed(&w));
}

TEST(without_a_name_a_second_dig_of_a_trajectory_is_asked_for)
{
    struct dig_trace_work w = work(3);
    search.unlisted         = true;
    assert_true(is_confirmed(&w));
    w               = work(2);
    search.unlisted = true;
    assert_false(is_confirmed(&w));
}

TEST(the_advice_begins_with_the_air_that_is_missing)
{
    const struct dig_trace_work w     = work(2);
    struct dig_trace            trace = { .advice = "" };
    assert_int_equal(dig_trace_explain(&w, &trace, NULL), DIG_OK);
    assert_memory_equal(trace.advice, "no free air in the recordings: effects of the machine", 53);
    assert_non_null(strstr(trace.advice, "Of the digs alone: a table computed with layering"));
    air.no_air = false;
    assert_int_equal(dig_trace_explain(&w, &trace, NULL), DIG_OK);
    assert_memory_equal(trace.advice, "a table computed with layering", 30);
}

TESTS_WITH(world_setup, world_teardown)
