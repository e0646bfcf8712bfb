// Tests for tables/load_file.c: what was dug with an effect, and what was not.

#include "tables/load.h"

#include "tests/tables_fixture.h"

static void put_varied(struct dig_store *const store, const double friction,
                       const char *const effect, const double magnitude, const size_t packing,
                       const size_t trajectory, const double my_Nm)
{
    const struct dig_run_origin plain = fixture_origin(friction, .5, 2500.0, packing, trajectory);
    fixture_put_run(store, fixture_varied(plain, effect, magnitude), my_Nm);
}

static void make_table(const char *const name)
{
    struct dig_store *const store = fixture_create(name);
    fixture_put(store, .3, .5, 0, 0, 1.0);
    put_varied(store, .9, "adhesion", 1.5, 0, 0, 5.0);
    put_varied(store, .3, "adhesion", 1.5, 0, 0, 4.0);
    put_varied(store, .3, "cohesion", 20, 0, 0, 3.0);
    put_varied(store, .3, "cohesion", 5, 0, 0, 2.0);
    put_varied(store, .3, "cohesion", 5, 1, 0, 2.5);
    put_varied(store, .3, "cohesion", 5, 0, 1, 7.0);
    dig_store_close(store);
}

TEST(effects_are_apart_from_what_is_plain)
{
    make_table("both.sqlite");
    struct dig_curve_set *const plain = fixture_load("both.sqlite");
    assert_int_equal(plain->entries, 1);
    assert_int_equal(plain->packings[0], 1);
    assert_close((double)plain->curve[0].mean[0][100], 1.0, 1e-6);

    struct dig_entry_set *set   = NULL;
    struct dig_error      error = { "" };
    assert_ok(dig_effects_load(scratch_path("both.sqlite"), plain, &set, &error), error);
    assert_string_equal(set->scene_hash, plain->scene_hash);
    assert_int_equal(set->trajectories, 2);
    assert_int_equal(set->entries, 4);
    // By effect as core/effect.h counts them, gravel, magnitude.
    static const struct {
        enum dig_effect_id effect;
        double             friction, magnitude, my_Nm;
        int                packings[2];
    } expected[] = {
        { DIG_EFFECT_COHESION, .3, 5, 2.25, { 2, 1 } },
        { DIG_EFFECT_COHESION, .3, 20, 3.0, { 1, 0 } },
        { DIG_EFFECT_ADHESION, .3, 1.5, 4.0, { 1, 0 } },
        { DIG_EFFECT_ADHESION, .9, 1.5, 5.0, { 1, 0 } },
    };
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(set->entry[i].effect, expected[i].effect);
        assert_close(set->entry[i].gravel.value[DIG_AXIS_FRICTION], expected[i].friction, 0.0);
        assert_close(set->entry[i].magnitude, expected[i].magnitude, 0.0);
        assert_int_equal(set->packings[2 * i], expected[i].packings[0]);
        assert_int_equal(set->packings[2 * i + 1], expected[i].packings[1]);
        assert_close((double)set->curve[2 * i].mean[DIG_CHANNEL_MY_Nm][50], expected[i].my_Nm,
                     1e-6);
        assert_close((double)set->curve[2 * i].mean[DIG_CHANNEL_CARRIED_kg][50],
                     5.0 * expected[i].my_Nm, 1e-5);
    }
    // One packing takes the relative spread of those with two: sqrt(.125) of 2.25.
    assert_close((double)set->curve[2 * 2].sd[0][50], 4.0 * sqrt(.125) / 2.25, 1e-5);
    dig_entry_set_destroy(set);
    dig_entry_set_destroy(NULL);
    dig_curve_set_destroy(plain);
}

TEST(a_table_of_effects_alone_is_no_table_of_curves)
{
    struct dig_store *const store = fixture_create("alone.sqlite");
    put_varied(store, .3, "cohesion", 5, 0, 0, 2.0);
    dig_store_close(store);
    struct dig_curve_set *plain   = NULL;
    struct dig_entry_set *effects = NULL;
    struct dig_error      error   = { "" };
    assert_int_equal(dig_table_load(scratch_path("alone.sqlite"), &plain, &error), DIG_EINVAL);
    assert_contains(error.text, "ground: no rows without an effect");
    assert_null(plain);
    assert_int_equal(dig_table_list(scratch_path("alone.sqlite"), &plain, &effects, NULL), DIG_OK);
    assert_int_equal(plain->entries, 0);
    assert_int_equal(effects->entries, 1);
    struct dig_entry_set *beside = NULL;
    assert_int_equal(dig_effects_load(scratch_path("alone.sqlite"), plain, &beside, NULL), DIG_OK);
    assert_int_equal(beside->entries, 1);
    dig_entry_set_destroy(beside);
    dig_entry_set_destroy(effects);
    dig_curve_set_destroy(plain);
}

TEST(what_does_not_belong_together_is_refused)
{
    make_table("mine.sqlite");
    struct dig_scene  other = fixture_scene();
    struct dig_store *store = NULL;
    other.material.young_Pa = 6e6;
    (void)snprintf(other.name, sizeof other.name, "stiffer");
    assert_int_equal(dig_store_create(scratch_path("theirs.sqlite"), &other, &store, NULL), DIG_OK);
    put_varied(store, .3, "cohesion", 5, 0, 0, 2.0);
    dig_store_close(store);

    struct dig_curve_set *const plain = fixture_load("mine.sqlite");
    struct dig_entry_set       *set   = NULL;
    struct dig_error            error = { "" };
    assert_refused(dig_effects_load(scratch_path("theirs.sqlite"), plain, &set, &error), error,
                   DIG_EINVAL, "theirs.sqlite: scene: holds \"stiffer\" (");
    assert_contains(error.text, "\"tub\" (");
    store = fixture_create("plain.sqlite");
    fixture_put(store, .3, .5, 0, 0, 1.0);
    dig_store_close(store);
    assert_refused(dig_effects_load(scratch_path("plain.sqlite"), plain, &set, &error), error,
                   DIG_EINVAL, "plain.sqlite: ground: no rows with an effect");
    (void)fixture_copy_sealed("mine.sqlite", "odd.sqlite",
                              "UPDATE ground SET effect = 'gremlins' WHERE effect = 'cohesion'");
    assert_int_equal(dig_effects_load(scratch_path("odd.sqlite"), plain, &set, &error), DIG_EINVAL);
    assert_contains(error.text, "ground.effect: \"gremlins\" of magnitude");
    assert_null(set);
    dig_curve_set_destroy(plain);
}

TEST(a_run_whose_effect_nobody_knows_is_not_stored)
{
    struct dig_store *const    store     = fixture_create("refuse.sqlite");
    const struct dig_recording recording = fixture_recording(400, 1.0);
    struct dig_error           error     = { "" };
    struct dig_run_origin      origin =
        fixture_varied(fixture_origin(.3, .5, 2500.0, 0, 0), "gremlins", 1.0);
    assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "effect \"gremlins\"");
    origin = fixture_varied(origin, "", 1.0);
    assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "magnitude 1 of effect \"\", expected 0");
    origin = fixture_varied(origin, "cohesion", (double)NAN);
    assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
    dig_store_close(store);
}

// A measured dig does not know the carried mass: neither does an entry it is part of.
TEST(a_carried_mass_that_is_not_known_stays_so)
{
    struct dig_store *const store = fixture_create("carried.sqlite");
    fixture_put(store, .3, .5, 0, 0, 1.0);
    fixture_put(store, .9, .5, 0, 0, 1.0);
    const struct dig_run_origin origin    = fixture_origin(.3, .5, 2500.0, 1, 0);
    struct dig_recording        recording = fixture_recording(400, 2.0);
    recording.row[399].carried_kg         = (double)NAN;
    assert_int_equal(dig_store_put(store, &origin, &recording, NULL), DIG_OK);
    struct dig_store_report report = { .runs = 0 };
    assert_int_equal(dig_store_check(store, &report, NULL), DIG_OK);
    dig_store_close(store);
    struct dig_curve_set *const plain = fixture_load("carried.sqlite");
    assert_true(isnan(plain->curve[0].mean[DIG_CHANNEL_CARRIED_kg][100]));
    assert_true(isnan(plain->curve[0].sd[DIG_CHANNEL_CARRIED_kg][100]));
    assert_close((double)plain->curve[0].mean[DIG_CHANNEL_MY_Nm][100], 1.5, 1e-6);
    assert_close((double)plain->curve[2].mean[DIG_CHANNEL_CARRIED_kg][100], 5.0, 1e-6);
    dig_curve_set_destroy(plain);
}

TESTS_WITH(scratch_setup, scratch_teardown)
