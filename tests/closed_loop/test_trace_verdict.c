#include "closed_loop/verdict/trace_work.h"

#include "estimator/effects/effect.h"
#include "tests/closed_loop/world_fixture.h"

#include <string.h>

enum { DIGS = 6, DRAWS = 24 };

static struct dig_measured             measured[DIGS];
static struct dig_batch                batch;
static struct dig_search               found;
static struct dig_machine_finding      shown;
static const struct dig_trace_settings settings = { .false_alarm = 0.01 };

// Six digs, searched as they are: what the soil's side of a verdict is made of.
static struct dig_trace_work search(const enum dig_effect_id effect, const double magnitude)
{
    const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
    uint64_t                seed   = 51;
    dig_in_turn(DIGS, &gravel, 1, &effect, &magnitude, &seed, measured);
    batch_digs(DIGS, measured, &gravel, &batch);
    dig_search_run(&batch, settings.false_alarm, DRAWS, seed, &found);
    return (struct dig_trace_work){ .set      = world.set,
                                    .surface  = world.surface,
                                    .scatter  = world.scatter,
                                    .soil     = soil,
                                    .settings = &settings,
                                    .digs     = DIGS,
                                    .measured = measured,
                                    .batch    = &batch,
                                    .before   = found.plain,
                                    .search   = &found,
                                    .air      = &shown };
}

static void fill_verdict(const struct dig_trace_work *const      t,
                         const struct dig_machine_finding *const air, struct dig_trace *const trace)
{
    shown = *air;
    dig_trace_fill_verdict(t, trace);
}

static double largest_correction(const struct dig_model_unlisted *const u)
{
    double most = 0.0;
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                most = fmax(most, fabs((double)u->share[t][c][k]));
            }
        }
    }
    return most;
}

// Whose it is, the soil's or the machine's, decides no more than the name.
TEST(what_has_no_name_is_corrected_whatever_free_air_shows)
{
    const struct dig_trace_work t          = search(DIG_EFFECT_UNLISTED, 1.2);
    struct dig_machine_finding  air        = { .p_complete = 1.0 };
    struct dig_trace            understood = { 0 };
    struct dig_trace            strange    = { 0 };
    fill_verdict(&t, &air, &understood);
    air = (struct dig_machine_finding){ .significant = true, .unexplained = true };
    fill_verdict(&t, &air, &strange);

    assert_int_equal(understood.effects, 1);
    assert_int_equal(understood.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_true(largest_correction(&understood.unlisted) > 0.2);
    assert_int_equal(strange.effects, 1);
    assert_int_equal(strange.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_memory_equal(&strange.unlisted, &understood.unlisted, sizeof strange.unlisted);
}

TEST(what_free_air_alone_shows_is_seen_in_the_air)
{
    const struct dig_trace_work      t     = search(DIG_EFFECT_LAYERING, 0.0);
    const struct dig_machine_finding air   = { .significant = true,
                                               .unexplained = true,
                                               .p_complete  = 1e-5 };
    struct dig_trace                 trace = { 0 };
    assert_false(found.significant);
    fill_verdict(&t, &air, &trace);
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_int_equal(trace.seen_in[0], DIG_PART_AIR);
    assert_close(trace.effect[0].probability, 1.0 - 1e-5, 1e-12);
    assert_non_null(strstr(trace.unlisted.depends_on, "free air"));
    assert_close(largest_correction(&trace.unlisted), 0.0, 0.0); // the digs show nothing
}

// What the digs do not confirm is claimed as far as they do, wherever it is seen.
TEST(what_has_no_name_is_weighed)
{
    const struct dig_machine_finding told    = { .p_complete = 1.0 };
    const struct dig_machine_finding strange = { .significant = true,
                                                 .unexplained = true,
                                                 .p_complete  = 1e-5 };
    struct dig_trace_work            t       = search(DIG_EFFECT_UNLISTED, 1.2);
    struct dig_trace                 trace   = { 0 };
    assert_close(found.unnamed, 1.0, 0.0);
    found.unnamed = 0.6;
    fill_verdict(&t, &told, &trace);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_close(trace.effect[0].probability, 0.6 * (1.0 - found.p_complete), 1e-12);

    t             = search(DIG_EFFECT_LAYERING, 0.0);
    trace         = (struct dig_trace){ 0 };
    found.unnamed = 0.6;
    fill_verdict(&t, &strange, &trace);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_close(trace.effect[0].probability, 0.6 * (1.0 - 1e-5), 1e-12);
}

// Without free air what has a name may be the machine's as well as what has none.
TEST(without_free_air_no_more_than_even_odds_are_claimed)
{
    const struct dig_machine_finding told  = { .p_complete = 1.0 };
    const struct dig_machine_finding none  = { .p_complete = 1.0, .no_air = true };
    struct dig_trace_work            t     = search(DIG_EFFECT_LAYERING, 0.8);
    struct dig_trace                 with  = { 0 };
    struct dig_trace                 trace = { 0 };
    fill_verdict(&t, &told, &with);
    fill_verdict(&t, &none, &trace);
    assert_true(with.effect[0].probability > 0.9);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_LAYERING);
    assert_close(trace.effect[0].probability, 0.5, 0.0);

    t     = search(DIG_EFFECT_UNLISTED, 1.2);
    trace = (struct dig_trace){ 0 };
    fill_verdict(&t, &none, &trace);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_close(trace.effect[0].probability, 0.5, 0.0);
}

TEST(what_has_no_name_is_seen_where_the_residual_is_largest)
{
    const struct dig_trace_work      t   = search(DIG_EFFECT_UNLISTED, 1.2);
    const struct dig_machine_finding air = { .p_complete = 1.0 };
    const double                     gap = (double)NAN;
    const struct {
        double        soil, lifted;
        enum dig_part seen_in;
    } cases[] = { { 3.0, 1.0, DIG_PART_SOIL },
                  { 2.0, 4.0, DIG_PART_LIFTED },
                  { 2.0, gap, DIG_PART_SOIL } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct dig_trace trace = { .residual = { gap, cases[i].soil, cases[i].lifted } };
        fill_verdict(&t, &air, &trace);
        assert_int_equal(trace.seen_in[0], cases[i].seen_in);
    }
}

TEST(both_sides_are_named_the_machine_first)
{
    const struct dig_trace_work      t   = search(DIG_EFFECT_LAYERING, 0.8);
    const struct dig_machine_finding air = {
        .significant = true,
        .effects     = 1,
        .effect      = { { .effect = DIG_EFFECT_BUCKET_WEIGHT, .probability = 0.9 } },
        .sets        = 1,
        .set         = { { 2, { DIG_EFFECT_BUCKET_WEIGHT, DIG_EFFECT_PAYLOAD } } },
    };
    struct dig_trace trace = { 0 };
    fill_verdict(&t, &air, &trace);
    assert_int_equal(trace.effects, 2);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_BUCKET_WEIGHT);
    assert_int_equal(trace.seen_in[0], DIG_PART_AIR);
    assert_int_equal(trace.effect[1].effect, DIG_EFFECT_LAYERING);
    assert_int_equal(trace.seen_in[1], DIG_PART_SOIL);
    assert_int_equal(trace.sets, found.alike.effects > 0 ? 2 : 1);
    assert_int_equal(trace.set[0].effect[1], DIG_EFFECT_PAYLOAD);
    assert_false(trace.unlisted.any);
}

// What free air shows with the digs' help only is not seen in it.
TEST(a_machine_that_the_digs_show_is_seen_in_the_soil)
{
    const struct dig_trace_work      t   = search(DIG_EFFECT_LAYERING, 0.0);
    const struct dig_machine_finding air = {
        .significant = true,
        .effects     = 1,
        .effect      = { { .effect = DIG_EFFECT_LINKAGE_GEOMETRY, .probability = 0.5 } },
        .by_digs     = true,
    };
    struct dig_trace trace = { 0 };
    fill_verdict(&t, &air, &trace);
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_LINKAGE_GEOMETRY);
    assert_int_equal(trace.seen_in[0], DIG_PART_SOIL);
}

TEST(a_strange_machine_leaves_the_soil_without_a_name)
{
    struct dig_trace_work            t     = search(DIG_EFFECT_LAYERING, 0.8);
    const struct dig_machine_finding air   = { .significant = true, .unexplained = true };
    const struct dig_machine_finding known = { .significant = true };
    struct dig_trace                 trace = { 0 };
    shown                                  = known;
    dig_trace_doubt_soil(&t);
    assert_false(found.unlisted);
    shown = air;
    dig_trace_doubt_soil(&t);
    fill_verdict(&t, &air, &trace);
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_int_equal(trace.sets, 0);
    assert_close(largest_correction(&trace.unlisted), 0.0, 0.0);
}

// Named, and corrected by what was measured: its model says where, and adds no template.
TEST(a_rock_elsewhere_is_an_obstacle_without_a_template)
{
    const struct dig_trace_work      t     = search(DIG_EFFECT_UNLISTED, 1.2);
    const struct dig_machine_finding air   = { .p_complete = 1.0 };
    struct dig_trace                 trace = { 0 };
    found.is_rock                          = true;
    found.rock = (struct dig_rock){ .ahead_m = 0.03, .low_m = 0.02, .high_m = 0.05 };
    fill_verdict(&t, &air, &trace);
    assert_int_equal(trace.effects, 1);
    assert_int_equal(trace.effect[0].effect, DIG_EFFECT_OBSTACLE);
    assert_int_equal(trace.seen_in[0], DIG_PART_SOIL);
    assert_true(largest_correction(&trace.unlisted) > 0.2);
    double value[DIG_MODEL_PARAMETERS_MAX];
    assert_int_equal(dig_effect_values(&trace.effect[0], value), DIG_OK);
    assert_close(value[0], 0.0, 0.0);
    assert_close(value[1], 0.03, 1e-12);
    dig_trace_fill_candidates(&t, &trace);
    assert_int_equal(trace.candidates, 1 + found.rivals);
    assert_int_equal(trace.candidate[0].as.effect, DIG_EFFECT_OBSTACLE);
    assert_string_equal(trace.candidate[0].as.parameter[0].name, "ahead_m");
}

TESTS_WITH(world_setup, world_teardown)
