// Tests for estimator/effects: the list, templates, and a model's effects in a table's curves.

#include "estimator/effects/effect.h"

#include "core/outline.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { BASES = 2, ENTRIES = 5 };

// Cohesion 1e4 and 2e4 at a weak and a strong base, and a slope at the strong one, made up: each
// adds `share` of the plain curve's rms throughout.
static const struct {
    enum dig_effect_id effect;
    double             magnitude;
    int                base;
    double             share;
} beds[ENTRIES] = {
    { DIG_EFFECT_COHESION, 1e4, 0, 0.2 },      { DIG_EFFECT_COHESION, 2e4, 0, 0.3 },
    { DIG_EFFECT_COHESION, 1e4, 1, 0.4 },      { DIG_EFFECT_COHESION, 2e4, 1, 0.8 },
    { DIG_EFFECT_GROUND_SLOPE, 10.0, 1, 0.5 },
};

static const struct dig_gravel base[BASES] = { { { 0.3, 0.1, 2500 } }, { { 0.9, 1.0, 2500 } } };

static double rms_My(const struct dig_gravel *const g)
{
    double sum = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += pow(made_moment_Nm(g, MADE_SIMPLE_A, (double)k / (DIG_CURVE_POINTS - 1), 0.0), 2.0);
    }
    return sqrt(sum / DIG_CURVE_POINTS);
}

struct world {
    struct dig_curve_set *plain, *out;
    struct dig_entry_set  effects;
    struct dig_entry      entry[ENTRIES];
    int                   packings[ENTRIES * MADE_TRAJECTORIES];
    struct dig_curve     *curve;
};

static struct world *make_world(void)
{
    const struct made_options options = { .relative_sd = 0.1, .packings = 5 };
    struct world *const       w       = calloc(1, sizeof *w);
    w->plain                          = made_table(&options);
    w->out                            = made_table(&options);
    w->curve                          = calloc(ENTRIES * MADE_TRAJECTORIES, sizeof *w->curve);
    for (int e = 0; e < ENTRIES; e++) {
        w->entry[e]               = (struct dig_entry){ .effect    = beds[e].effect,
                                                        .magnitude = beds[e].magnitude,
                                                        .gravel    = base[beds[e].base] };
        struct dig_curve *const c = &w->curve[e * MADE_TRAJECTORIES + MADE_SIMPLE_A];
        w->packings[e * MADE_TRAJECTORIES + MADE_SIMPLE_A] = 4;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const struct dig_gravel *const g = &w->entry[e].gravel;
            const double                   p =
                made_moment_Nm(g, MADE_SIMPLE_A, (double)k / (DIG_CURVE_POINTS - 1), 0.0);
            const double by[DIG_CHANNELS] = { 1.0, -8.0, 5.0, 0.2 };
            for (int ch = 0; ch < DIG_CHANNELS; ch++) {
                c->mean[ch][k] = (float)(by[ch] * p + fabs(by[ch]) * beds[e].share * rms_My(g));
                c->sd[ch][k]   = (float)(0.3 * fabs(by[ch]) * rms_My(g));
            }
        }
    }
    w->effects = (struct dig_entry_set){ .trajectories = MADE_TRAJECTORIES,
                                         .entries      = ENTRIES,
                                         .entry        = w->entry,
                                         .packings     = w->packings,
                                         .curve        = w->curve };
    return w;
}

static void free_world(struct world *const w)
{
    made_table_destroy(w->plain);
    made_table_destroy(w->out);
    free(w->curve);
    free(w);
}

// What the template adds to My, in the gravel's own rms; NaN when there is none.
static double share_at(const struct world *const w, const enum dig_effect_id effect,
                       const double magnitude, const struct dig_gravel *const g)
{
    struct dig_template t;
    if (dig_template_find(w->plain, &w->effects, effect, magnitude, g, MADE_SIMPLE_A, &t) !=
        DIG_OK) {
        return (double)NAN;
    }
    return t.delta[DIG_CHANNEL_MY_Nm][128] / rms_My(g);
}

TEST(templates_go_through_their_beds_and_straight_between)
{
    struct world *const w = make_world();
    assert_close(share_at(w, DIG_EFFECT_COHESION, 1e4, &base[0]), 0.2, 1e-5);
    assert_close(share_at(w, DIG_EFFECT_COHESION, 1.5e4, &base[0]), 0.25, 1e-5);
    assert_close(share_at(w, DIG_EFFECT_COHESION, 0.5e4, &base[0]), 0.1, 1e-5);
    assert_close(share_at(w, DIG_EFFECT_COHESION, 0.0, &base[0]), 0.0, 1e-9);
    assert_close(share_at(w, DIG_EFFECT_COHESION, 3e4, &base[1]), 1.2, 1e-5);
    // A slope the other way goes on straight, half as far.
    assert_close(share_at(w, DIG_EFFECT_GROUND_SLOPE, -4.0, &base[1]), -0.2, 1e-5);
    // Contacts 1.6 times as stiff need 1.6 times the cohesion, be they so by the density or less.
    const struct dig_gravel heavy = { { 0.9, 1.0, 4000 } };
    assert_close(share_at(w, DIG_EFFECT_COHESION, 1.6e4, &heavy), 0.4, 1e-5);
    w->plain->stiffness_power = 0.2;
    assert_close(share_at(w, DIG_EFFECT_COHESION, 1e4 * pow(1.6, 0.2), &heavy), 0.4, 1e-5);
    // Between the bases by strength.
    const struct dig_gravel middle = { { 0.6, 0.55, 2500 } };
    const double            f =
        log(rms_My(&middle) / rms_My(&base[0])) / log(rms_My(&base[1]) / rms_My(&base[0]));
    assert_close(share_at(w, DIG_EFFECT_COHESION, 1e4, &middle), (1 - f) * 0.2 + f * 0.4, 1e-4);
    free_world(w);
}

TEST(where_there_is_no_bed_there_is_no_template)
{
    struct world *const w   = make_world();
    double              low = 7.0, high = 7.0;
    assert_true(dig_template_range(&w->effects, DIG_EFFECT_COHESION, MADE_SIMPLE_A, &low, &high));
    assert_close(low, 0.0, 0.0);
    assert_close(high, 3e4, 1e-6);
    assert_true(
        dig_template_range(&w->effects, DIG_EFFECT_GROUND_SLOPE, MADE_SIMPLE_A, &low, &high));
    assert_close(low, -5.0, 1e-9);
    assert_close(high, 15.0, 1e-9);
    assert_false(dig_template_range(&w->effects, DIG_EFFECT_COHESION, MADE_ACTUAL, &low, &high));
    assert_false(dig_template_range(NULL, DIG_EFFECT_COHESION, MADE_SIMPLE_A, &low, &high));
    const struct dig_gravel outside = { { 0.1, 0.5, 2500 } };
    assert_true(isnan(share_at(w, DIG_EFFECT_COHESION, 3.1e4, &base[0])));
    assert_true(isnan(share_at(w, DIG_EFFECT_COHESION, -1.0, &base[0])));
    assert_true(isnan(share_at(w, DIG_EFFECT_OBSTACLE, 0.01, &base[0])));
    assert_true(isnan(share_at(w, DIG_EFFECT_COHESION, 1e4, &outside)));
    assert_close(dig_template_absent(DIG_EFFECT_GRAIN_SHAPE), 1.0, 0.0);
    free_world(w);
}

TEST(a_templates_sigma_is_that_of_two_means)
{
    struct world *const w = make_world();
    struct dig_template t;
    assert_int_equal(dig_template_find(w->plain, &w->effects, DIG_EFFECT_COHESION, 1e4, &base[1],
                                       MADE_SIMPLE_A, &t),
                     DIG_OK);
    const double plain = made_moment_Nm(&base[1], MADE_SIMPLE_A, 128.0 / 255.0, 0.0);
    const double truth = sqrt(pow(0.3 * rms_My(&base[1]), 2.0) / 4 + pow(0.1 * plain, 2.0) / 5);
    assert_close(t.sigma[DIG_CHANNEL_MY_Nm][128], truth, 1e-4 * truth);
    free_world(w);
}

TEST(every_effect_is_listed_and_absent_changes_nothing)
{
    const struct dig_machine machine = model_machine();
    struct dig_curve *const  curve   = calloc(1, sizeof *curve);
    curve->mean[0][7]                = 3.0F;
    assert_null(dig_effect_of(DIG_EFFECT_UNLISTED));
    for (int e = 0; e < DIG_EFFECT_UNLISTED; e++) {
        const struct dig_effect *const effect = dig_effect_of((enum dig_effect_id)e);
        assert_int_equal(effect->id, e);
        assert_true(effect->parameters >= 1 && effect->parameters <= DIG_MODEL_PARAMETERS_MAX);
        assert_int_equal(effect->correct != NULL, dig_effect_is_of_machine(effect->id));
        double value[DIG_MODEL_PARAMETERS_MAX];
        dig_effect_absent(effect, value);
        for (size_t p = 0; p < effect->parameters; p++) {
            assert_true(effect->parameter[p].low <= value[p] &&
                        value[p] <= effect->parameter[p].high);
            assert_true(effect->parameter[p].scale > 0.0);
            assert_true(strlen(effect->parameter[p].name) < DIG_NAME_SIZE);
        }
        if (effect->correct != NULL) {
            struct dig_correction c = { .delay_s = 0.0 };
            effect->correct(value, &c);
            const struct dig_machine same = dig_correction_machine(&machine, &c);
            assert_memory_equal(&same.four_bar, &machine.four_bar, sizeof same.four_bar);
            assert_close(same.link[2].mass_kg, machine.link[2].mass_kg, 0.0);
            assert_close(c.friction[1].coulomb_N + c.offset_Pa[1][0] + c.delay_s, 0.0, 0.0);
        }
        if (effect->reduce != NULL) {
            double delta[DIG_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
            effect->reduce(value, curve, delta);
            assert_close(delta[0][7], 0.0, 0.0);
        }
        if (effect->factor != NULL) {
            assert_close(effect->factor(value, 5.0, 2.0), 0.0, 0.0);
        }
        assert_true(effect->templated || !effect->whole);
        assert_int_equal(effect->templated || effect->factor != NULL || effect->reduce != NULL,
                         !dig_effect_is_of_machine(effect->id));
    }
    free(curve);
}

// Two digs after three are the fifth.
TEST(what_counts_digs_goes_on_where_it_was_left)
{
    size_t count = 0;
    for (int e = 0; e < DIG_EFFECT_UNLISTED; e++) {
        const struct dig_effect *const effect = dig_effect_of((enum dig_effect_id)e);
        if (effect->digs_done == 0) {
            continue;
        }
        double value[DIG_MODEL_PARAMETERS_MAX];
        dig_effect_absent(effect, value);
        assert_int_equal(effect->by, DIG_BY_ORDER);
        assert_true(effect->digs_done < effect->parameters && effect->factor != NULL);
        value[0]           = effect->parameter[0].scale;
        const double fifth = effect->factor(value, 5.0, 1.0);
        assert_true(fabs(fifth) > 0.0);
        value[effect->digs_done] = 3.0;
        assert_close(effect->factor(value, 2.0, 1.0), fifth, 1e-12);
        count++;
    }
    assert_true(count > 0);
}

TEST(values_go_by_name_and_strangers_are_refused)
{
    struct dig_model_effect found                           = { .effect     = DIG_EFFECT_WEAR,
                                                                .parameters = 1,
                                                                .parameter  = { { "digs", 12.0, 0.0, 0.0 } } };
    double                  value[DIG_MODEL_PARAMETERS_MAX] = { 7.0, 7.0 };
    assert_int_equal(dig_effect_values(&found, value), DIG_OK);
    assert_close(value[0], 0.0, 0.0);
    assert_close(value[1], 12.0, 0.0);
    found.parameter[0].value = -1.0;
    assert_int_equal(dig_effect_values(&found, value), DIG_EINVAL);
    assert_close(value[1], 12.0, 0.0);
    memcpy(found.parameter[0].name, "dugs", 5);
    found.parameter[0].value = 1.0;
    assert_int_equal(dig_effect_values(&found, value), DIG_EINVAL);
}

TEST(a_model_changes_the_tables_curves)
{
    struct world *const w     = make_world();
    struct dig_model    model = {
           .effects  = 2,
           .effect   = { { .effect     = DIG_EFFECT_COHESION,
                           .parameters = 1,
                           .parameter  = { { "cohesion_Jpm3", 1e4, 0, 0 } } },
                         { .effect     = DIG_EFFECT_WEAR,
                           .parameters = 2,
                           .parameter = { { "share_per_dig", 0.1, 0, 0 }, { "digs", 3.0, 0, 0 } } } },
           .unlisted = { .any = true }
    };
    model.unlisted.share[MADE_ACTUAL][DIG_CHANNEL_MY_Nm][128] = 0.5F;
    // Cohesion has beds along simpleA alone: elsewhere it is not known, and nowhere without a set.
    assert_int_equal(dig_effects_apply(w->plain, &w->effects, &model, w->out), DIG_OK);
    assert_int_equal(w->out->packings[MADE_SIMPLE_A], 5);
    assert_int_equal(w->out->packings[MADE_ACTUAL], 0);
    // What the template errs by is in the spread, and told apart from it.
    const struct dig_curve *const with = &w->out->curve[MADE_SIMPLE_A];
    double                        more = 0.0, square = 0.0, block = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        block += k < DIG_OUTLINE_POINTS ? (double)with->mean[0][k] / DIG_OUTLINE_POINTS : 0.0;
        more += pow((double)with->sd[0][k], 2.0) -
                pow((double)w->plain->curve[MADE_SIMPLE_A].sd[0][k], 2.0);
        square += pow((double)with->mean[0][k], 2.0);
    }
    assert_true(more > 0.004 * square);
    assert_close((double)with->error[0], sqrt(more / square), 1e-3 * sqrt(more / square));
    assert_close((double)dig_outline_mean(w->out, 0, MADE_SIMPLE_A)[0], block, 1e-6 * block);
    assert_int_equal(dig_effects_apply(w->plain, NULL, &model, w->out), DIG_ENOMATCH);
    model.effects   = 1;
    model.effect[0] = model.effect[1];
    assert_int_equal(dig_effects_apply(w->plain, NULL, &model, w->out), DIG_OK);
    for (size_t e = 0; e < w->plain->entries; e++) {
        const size_t a = e * MADE_TRAJECTORIES + MADE_SIMPLE_A,
                     b = e * MADE_TRAJECTORIES + MADE_ACTUAL;
        assert_close((double)w->out->curve[a].mean[0][100],
                     1.3 * (double)w->plain->curve[a].mean[0][100], 1e-5);
        double sum = 0.0;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            sum += pow((double)w->plain->curve[b].mean[0][k], 2.0) / DIG_CURVE_POINTS;
        }
        const double extra =
            (double)w->out->curve[b].mean[0][128] - 1.3 * (double)w->plain->curve[b].mean[0][128];
        assert_close(extra, 0.5 * sqrt(sum), 1e-4 * sqrt(sum));
    }
    free_world(w);
}

TEST(reduced_forms_grow_as_they_say)
{
    struct world *const         w   = make_world();
    const struct dig_effect_dig dig = {
        .trajectory = MADE_ACTUAL, .pass = 3, .order = 4, .pace = 4.0
    };
    struct dig_template t;
    const double        plain   = made_moment_Nm(&base[0], MADE_ACTUAL, 100.0 / 255.0, 0.0);
    const double        half[2] = { 0.5, 0.0 };
    assert_int_equal(dig_effect_add(dig_effect_of(DIG_EFFECT_RATE_DEPENDENCE), w->plain, NULL, half,
                                    &base[0], &dig, &t),
                     DIG_OK);
    assert_close(t.delta[0][100], plain, 1e-5);
    const double compaction[2] = { 0.0, 0.25 };
    assert_int_equal(dig_effect_add(dig_effect_of(DIG_EFFECT_COMPACTION), w->plain, NULL,
                                    compaction, &base[0], &dig, &t),
                     DIG_OK);
    assert_close(t.delta[0][100], 0.5 * plain, 1e-5);
    const double passes[2] = { 1.0, 0.0 };
    assert_int_equal(dig_effect_add(dig_effect_of(DIG_EFFECT_COMPACTION), w->plain, &w->effects,
                                    passes, &base[0], &dig, &t),
                     DIG_ENOMATCH);
    free_world(w);
}

// A layer of another material than the table's adds a multiple of what that adds; a model that says
// nothing of it means the table's.
TEST(a_layers_contrast_multiplies_its_template)
{
    struct world *const         w     = make_world();
    const struct dig_effect_dig dig   = { .trajectory = MADE_SIMPLE_A, .pass = 1, .pace = 1.0 };
    struct dig_model_effect     found = { .effect     = DIG_EFFECT_LAYERING,
                                          .parameters = 1,
                                          .parameter  = { { "layer_m", 5.0, 0, 0 } } };
    struct dig_template         t[2];
    w->entry[4].effect = DIG_EFFECT_LAYERING; // adds half of the plain dig's size at 10
    for (int i = 0; i < 2; i++) {
        double value[DIG_MODEL_PARAMETERS_MAX];
        assert_int_equal(dig_effect_values(&found, value), DIG_OK);
        assert_int_equal(dig_effect_add(dig_effect_of(DIG_EFFECT_LAYERING), w->plain, &w->effects,
                                        value, &base[1], &dig, &t[i]),
                         DIG_OK);
        found.parameters   = 2;
        found.parameter[1] = (struct dig_model_parameter){ "contrast", 0.4, 0, 0 };
    }
    assert_close(t[0].delta[0][100], 0.25 * rms_My(&base[1]), 1e-5);
    assert_close(t[1].delta[0][100], 0.4 * t[0].delta[0][100], 1e-9);
    assert_close(t[1].sigma[0][100], 0.4 * t[0].sigma[0][100], 1e-9);
    free_world(w);
}

// simpleA drags its tooth at 46.3 mm/s and lifts it at 91.5 mm/s, both far from where they change.
TEST(ground_may_feel_the_tooths_own_speed)
{
    struct world *const         w        = make_world();
    const struct dig_effect_dig dig      = { .trajectory = MADE_SIMPLE_A, .pass = 1, .pace = 2.0 };
    const double                along[2] = { 0.5, 1.0 };
    struct dig_template         t;
    double                      speed[DIG_CURVE_POINTS];
    dig_effect_speeds(w->plain, MADE_SIMPLE_A, speed);
    assert_close(speed[250] / speed[120], 91.5 / 46.3, 1e-3);
    assert_close(speed[100] / speed[120], 1.0, 1e-3);
    assert_int_equal(dig_effect_add(dig_effect_of(DIG_EFFECT_RATE_DEPENDENCE), w->plain, NULL,
                                    along, &base[0], &dig, &t),
                     DIG_OK);
    const double drag = made_moment_Nm(&base[0], MADE_SIMPLE_A, 120.0 / 255.0, 0.0);
    const double lift = made_moment_Nm(&base[0], MADE_SIMPLE_A, 250.0 / 255.0, 0.0);
    assert_close((1.0 + t.delta[0][250] / lift) / (1.0 + t.delta[0][120] / drag), sqrt(91.5 / 46.3),
                 2e-3);
    free_world(w);
}
