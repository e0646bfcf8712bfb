// Tests for firmware_host/config/load_model.c: what a model adds to a table's curves it adds to
// those that were dug at another depth or attack, too.

#include "firmware_host/config/load_model.h"

#include "core/entry_set.h"
#include "files/model_json.h"
#include "tests/tables_fixture.h"

#include <math.h>

static const struct dig_approach deep   = { 1.3, 0.0 };
static const struct dig_approach turned = { 1.0, 0.1 };

static void put(struct dig_store *const store, const double friction,
                const struct dig_approach approach, const double my_Nm)
{
    struct dig_run_origin origin = fixture_origin(friction, .5, 2500.0, 0, 0);
    origin.approach              = approach;
    fixture_put_run(store, origin, my_Nm);
}

// Two gravels that resist alike all along, dug plainly and in one other way each.
static struct dig_curve_set *make_table(const char *const name)
{
    const struct dig_scene  scene = fixture_diving_scene();
    struct dig_store *const store = fixture_create_of(name, &scene);
    put(store, .3, dig_approach_plain(), 1.0);
    put(store, .9, dig_approach_plain(), 5.0);
    put(store, .3, turned, 3.0);
    put(store, .9, deep, 8.0);
    dig_store_close(store);
    return fixture_load(name);
}

// A share of the moment that grows along the path: an effect without a name, so that no bed is
// needed to tell it.
static double share(const size_t k)
{
    return 0.2 * (double)k / (DIG_CURVE_POINTS - 1);
}

static struct dig_model model_of(const struct dig_curve_set *const set)
{
    struct dig_model model = {
        .table  = "here.sqlite",
        .gravel = { { 0.3, 0.5, 2500.0 } },
        .low    = { { 0.3, 0.5, 2500.0 } },
        .high   = { { 0.9, 0.5, 2500.0 } },
    };
    memcpy(model.scene_hash, set->scene_hash, sizeof model.scene_hash);
    return model;
}

// Saves the model, and loads it upon the table of that name.
static void apply(const struct dig_model *const model, const char *const name,
                  struct dig_curve_set *const set)
{
    char                         table[512], path[512];
    struct dig_corrected_machine corrected = { .corrects = true };
    struct dig_error             error     = { "" };
    (void)snprintf(table, sizeof table, "%s", scratch_path(name));
    (void)snprintf(path, sizeof path, "%s", scratch_path("model.json"));
    if (dig_model_save(path, model, &error) != DIG_OK ||
        dig_load_model(path, table, NULL, set, &corrected, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    assert_false(corrected.corrects);
}

TEST(digs_made_otherwise_change_as_the_plain_ones_do)
{
    struct dig_curve_set *const set   = make_table("ways.sqlite");
    struct dig_model            model = model_of(set);
    model.unlisted.any                = true;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        model.unlisted.share[0][DIG_CHANNEL_MY_Nm][k] = (float)share(k);
    }
    const struct dig_covariance *const covariance = set->covariance;
    assert_non_null(covariance);
    apply(&model, "ways.sqlite", set);
    assert_ptr_equal(set->covariance, covariance); // relative to the curves, as they are now
    const struct dig_entry_set *const other = set->approaches;
    assert_int_equal(other->entries, 2);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double more = 1.0 + share(k);
        assert_close((double)set->curve[0].mean[DIG_CHANNEL_MY_Nm][k], 1.0 * more, 1e-5);
        assert_close((double)set->curve[2].mean[DIG_CHANNEL_MY_Nm][k], 5.0 * more, 1e-5);

        // In proportion to what they resist with.
        assert_close((double)other->curve[0].mean[DIG_CHANNEL_MY_Nm][k], 3.0 * more, 1e-5);
        assert_close((double)other->curve[2].mean[DIG_CHANNEL_MY_Nm][k], 8.0 * more, 1e-5);

        // What the model does not speak of stays.
        assert_close((double)other->curve[0].mean[DIG_CHANNEL_FX_N][k], 6.0, 1e-5);
        assert_close((double)other->curve[2].mean[DIG_CHANNEL_FZ_N][k], -24.0, 1e-5);
    }
    dig_curve_set_destroy(set);
}

// Ground that resists less the slower it is dug takes a quarter of each curve of this table: of one
// that rises it takes more in its end.
TEST(each_changes_with_its_own_gravel)
{
    struct dig_store *const store = fixture_create("rise.sqlite");
    put(store, .3, dig_approach_plain(), 1.0);
    put(store, .3, turned, 3.0);
    struct dig_run_origin rising = fixture_origin(.9, .5, 2500.0, 0, 0);
    struct dig_recording  ramp   = fixture_ramp(400, 1.0, 4.0);
    assert_int_equal(dig_store_put(store, &rising, &ramp, NULL), DIG_OK);
    rising.approach = turned;
    ramp            = fixture_ramp(400, 2.0, 8.0);
    assert_int_equal(dig_store_put(store, &rising, &ramp, NULL), DIG_OK);
    dig_store_close(store);

    struct dig_curve_set *const before = fixture_load("rise.sqlite");
    struct dig_curve_set *const set    = fixture_load("rise.sqlite");
    struct dig_model            model  = model_of(set);
    model.effects                      = 1;
    model.effect[0] = (struct dig_model_effect){ .effect      = DIG_EFFECT_RATE_DEPENDENCE,
                                                 .probability = 1.0,
                                                 .parameters  = 2,
                                                 .parameter   = { { "exponent", 1.0, 1.0, 1.0 },
                                                                  { "along", 1.0, 1.0, 1.0 } } };
    apply(&model, "rise.sqlite", set);
    for (size_t i = 0; i < 2; i++) {
        const float *const is  = set->approaches->curve[2 * i].mean[DIG_CHANNEL_MY_Nm];
        const float *const was = before->approaches->curve[2 * i].mean[DIG_CHANNEL_MY_Nm];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            assert_close((double)is[k], 0.75 * (double)was[k], 2e-3 * (double)was[k]);
        }
    }
    dig_curve_set_destroy(before);
    dig_curve_set_destroy(set);
}

TESTS_WITH(scratch_setup, scratch_teardown)
