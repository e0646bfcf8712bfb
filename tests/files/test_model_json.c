// Tests for files/model_json.c

#include "files/model_json.h"

#include "tests/scratch.h"

static const char *const example_path = "tests/data/formats/model.json";

static struct dig_model example(void)
{
    struct dig_model m = {
        .table         = "tables/reference_rig.sqlite",
        .effects_table = "tables/reference_rig_effects.sqlite",
        .gravel        = { { 0.52, 0.41, 2500.0 } },
        .low           = { { 0.45, 0.3, 2300.0 } },
        .high          = { { 0.6, 0.5, 2700.0 } },
        .noise_floor   = 0.11,
        .error_before  = 0.31,
        .error_after   = (double)NAN, // no holdout: the key is left out
        .provenance    = "campaign \"north\\pit\", digloop 0.2",
        .effects       = 2,
        .effect        = { { .effect      = DIG_EFFECT_CYLINDER_FRICTION,
                             .probability = 0.98,
                             .parameters  = 2,
                             .parameter   = { { "coulomb_N", 812.0, 760.0, 861.0 },
                                              { "viscous_Nspm", -3.5, -20.0, 13.0 } } },
                           { .effect      = DIG_EFFECT_COHESION,
                             .probability = 0.7,
                             .parameters  = 1,
                             .parameter   = { { "cohesion_Jpm3", 5e4, 4e4, 6e4 } } } },
        .unlisted      = { .any = true, .depends_on = "depth" },
        .not_applied   = 1,
        .left_out      = { { .effect      = DIG_EFFECT_BUCKET_WEIGHT,
                             .probability = 0.5,
                             .parameters  = 1,
                             .parameter   = { { "mass_kg", 104.0, 96.0, 112.0 } } } },
    };
    memset(m.scene_hash, 'b', 64);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        m.unlisted.share[1][DIG_CHANNEL_FX_N][k] = 0.001F * (float)k;
    }
    return m;
}

TEST(what_was_written_is_read_back)
{
    struct dig_model  m     = example();
    struct dig_model  back  = { .effects = 0 };
    struct dig_error  error = { "" };
    const char *const path  = scratch_path("model.json");
    assert_ok(dig_model_save(path, &m, &error), error);
    assert_ok(dig_model_read(path, &back, &error), error);
    assert_string_equal(back.table, m.table);
    assert_string_equal(back.effects_table, m.effects_table);
    assert_string_equal(back.scene_hash, m.scene_hash);
    assert_string_equal(back.provenance, m.provenance);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(back.gravel.value[a], m.gravel.value[a], 1e-6);
        assert_close(back.low.value[a], m.low.value[a], 1e-6);
        assert_close(back.high.value[a], m.high.value[a], 1e-6);
    }
    assert_close(back.error_before, 0.31, 1e-9);
    assert_true(isnan(back.error_after));
    assert_int_equal(back.effects, 2);
    assert_int_equal(back.effect[1].effect, DIG_EFFECT_COHESION);
    assert_close(back.effect[0].probability, 0.98, 1e-6);
    assert_int_equal(back.effect[0].parameters, 2);
    assert_string_equal(back.effect[0].parameter[1].name, "viscous_Nspm");
    assert_close(back.effect[0].parameter[1].value, -3.5, 1e-9);
    assert_close(back.effect[0].parameter[0].low, 760.0, 1e-9);
    assert_int_equal(back.not_applied, 1);
    assert_int_equal(back.left_out[0].effect, DIG_EFFECT_BUCKET_WEIGHT);
    assert_close(back.left_out[0].parameter[0].high, 112.0, 1e-9);
    assert_true(back.unlisted.any);
    assert_string_equal(back.unlisted.depends_on, "depth");
    assert_close((double)back.unlisted.share[1][DIG_CHANNEL_FX_N][200], 0.2, 1e-6);
    assert_close((double)back.unlisted.share[0][DIG_CHANNEL_MY_Nm][200], 0.0, 0.0);
}

TEST(the_example_of_the_docs_is_read)
{
    struct dig_model model = { .effects = 0 };
    struct dig_error error = { "" };
    assert_ok(dig_model_read(example_path, &model, &error), error);
    assert_int_equal(model.effects, 1);
    assert_false(model.unlisted.any);
}

// The example with one text replaced.
static const char *spoilt(const char *const find, const char *const put)
{
    char        text[4096];
    FILE *const file = fopen(example_path, "r");
    assert_non_null(file);
    const size_t n = fread(text, 1, sizeof text - 1, file);
    (void)fclose(file);
    text[n]        = '\0';
    char *const at = strstr(text, find);
    assert_non_null(at);
    const char *const path = scratch_path("spoilt.json");
    FILE *const       out  = fopen(path, "w");
    (void)fprintf(out, "%.*s%s%s", (int)(at - text), text, put, at + strlen(find));
    (void)fclose(out);
    return path;
}

TEST(defects_are_refused_by_key_and_write_nothing)
{
    const struct {
        const char *find, *put, *named;
    } cases[] = {
        { "\"version\": 1", "\"version\": 2", "version" },
        { "cylinder_friction", "cylinder_fiction", "cylinder_fiction" },
        { "coulomb_N", "coulomb'N", "\"coulomb'N\" of cylinder_friction, expected a name" },
        { "coulomb_N", "coulomb\\u001bN", "effects[0].parameters[0].name: \"coulomb?N\"" },
        { "\"probability\": 0.98", "\"probability\": 1.2", "probability" },
        { "\"value\": 812", "\"value\": .nan", "parameters[0].value" },
        { "\"friction\": 0.52", "\"friction\": -1", "gravel" },
        { "\"table\"", "\"tabel\"", "tabel" },
        { "\"effects\": [", "\"effects\": 3, \"x\": [", "effects" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct dig_model model = { .effects = 7 };
        struct dig_error error = { "" };
        assert_int_equal(dig_model_read(spoilt(cases[i].find, cases[i].put), &model, &error),
                         DIG_EINVAL);
        assert_contains(error.text, cases[i].named);
        assert_int_equal(model.effects, 7);
    }
    struct dig_model model = { .effects = 7 };
    struct dig_error error = { "" };
    assert_int_equal(dig_model_read("/nowhere/model.json", &model, &error), DIG_EIO);
    assert_int_equal(model.effects, 7);
}

TESTS_WITH(scratch_setup, scratch_teardown)
