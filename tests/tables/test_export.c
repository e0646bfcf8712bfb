// Tests for tables/export.c: what digtable prints is what docs/formats.md shows.

#include "tables/export.h"

#include "tables/load.h"
#include "tests/tables_fixture.h"

static struct dig_entry_set *effects;

static struct dig_curve_set *example(void)
{
    struct dig_store *const store = fixture_create("example.sqlite");
    fixture_put(store, .3, .5, 0, 0, 1.0);
    fixture_put(store, .3, .5, 1, 0, 2.0);
    fixture_put(store, .9, .5, 0, 0, 0.5);
    fixture_put(store, .9, .5, 0, 1, 0.25);
    const struct dig_run_origin varied =
        fixture_varied(fixture_origin(.9, .5, 2500.0, 0, 1), "cohesion", 1000.0);
    const struct dig_recording recording = fixture_recording(200, 0.5);
    assert_int_equal(dig_store_put(store, &varied, &recording, NULL), DIG_OK);
    dig_store_close(store);
    struct dig_curve_set *set = NULL;
    dig_entry_set_destroy(effects);
    assert_int_equal(dig_table_list(scratch_path("example.sqlite"), &set, &effects, NULL), DIG_OK);
    (void)unlink(scratch_path("example.sqlite"));
    return set;
}

// What is written between the two is read back, malloc'ed.
static FILE *begin(void)
{
    FILE *const file = fopen(scratch_path("printed"), "wb");
    assert_non_null(file);
    return file;
}

static char *end(FILE *const file)
{
    size_t size = 0;
    assert_int_equal(fclose(file), 0);
    return scratch_read(scratch_path("printed"), &size);
}

static void assert_is_example(char *const printed, const char *const path)
{
    size_t      size     = 0;
    char *const expected = scratch_read(path, &size);
    assert_string_equal(printed, expected);
    free(expected);
    free(printed);
}

TEST(the_list_is_the_example_of_the_formats)
{
    struct dig_curve_set *const set  = example();
    FILE                       *file = begin();
    dig_export_list_json(set, effects, file);
    assert_is_example(end(file), "tests/data/formats/digtable_list.json");
    file = begin();
    dig_export_list(set, effects, file);
    char *const text = end(file);
    assert_contains(text, "scene tub ");
    assert_contains(text, "    1       0.9       0.5      2500            1           1\n");
    assert_contains(
        text, "            0.9       0.5      2500            0           1  cohesion 1000\n");
    free(text);
    dig_curve_set_destroy(set);
}

TEST(a_name_is_quoted_in_json)
{
    struct dig_curve_set *const set = example();
    (void)snprintf(set->scene_name, sizeof set->scene_name, "a\"b\\c\nd");
    FILE *const file = begin();
    dig_export_list_json(set, effects, file);
    char *const text = end(file);
    assert_contains(text, "\"name\": \"a\\\"b\\\\c\\u000ad\"");
    free(text);
    dig_curve_set_destroy(set);
}

// Lines of a CSV, and the second of them.
static size_t lines_of(const char *text, char second[const 256])
{
    size_t lines = 0;
    for (const char *stop; (stop = strchr(text, '\n')) != NULL; text = stop + 1) {
        if (++lines == 2) {
            (void)snprintf(second, 256, "%.*s", (int)(stop - text), text);
        }
    }
    return lines;
}

TEST(curves_are_one_line_a_point)
{
    struct dig_curve_set *const set = example();
    char                        second[256];
    FILE                       *file = begin();
    dig_export_curves(set, file);
    char *text = end(file);
    assert_int_equal(lines_of(text, second), 1 + 3 * DIG_CURVE_POINTS);
    assert_ptr_equal(
        strstr(
            text,
            "friction,rolling,density_kgpm3,trajectory,packings,progress,t_s,"
            "My_Nm,My_sd_Nm,Fx_N,Fx_sd_N,Fz_N,Fz_sd_N,carried_kg,carried_sd_kg,depth,attack_deg\n"),
        text);
    assert_string_equal(second, "0.3,0.5,2500,pull,2,0,0,1.5,0.707106769,3,1.41421354,-4.5,"
                                "2.12132025,7.5,3.53553391,1,0");
    free(text);

    file = begin();
    dig_export_curve_csv(set, 1, 1, file);
    text = end(file);
    assert_int_equal(lines_of(text, second), 1 + DIG_CURVE_POINTS);
    assert_contains(text,
                    "\n1,1,0.25,0.05"); // the end: progress 1, at 1 s, spread a fifth of the rms
    free(text);
    dig_curve_set_destroy(set);
}

TEST(curves_with_an_effect_are_a_table_of_their_own)
{
    struct dig_curve_set *const set = example();
    char                        second[256];
    FILE *const                 file = begin();
    dig_export_effects(set, effects, file);
    char *const text = end(file);
    assert_int_equal(lines_of(text, second), 1 + DIG_CURVE_POINTS);
    assert_ptr_equal(
        strstr(text, "effect,magnitude,friction,rolling,density_kgpm3,trajectory,packings,"), text);
    assert_ptr_equal(strstr(second, "cohesion,1000,0.9,0.5,2500,push,1,0,0,0.5,0.1"), second);
    free(text);
    dig_curve_set_destroy(set);
}

TEST(one_curve_as_json_holds_every_array)
{
    struct dig_curve_set *const set  = example();
    FILE *const                 file = begin();
    dig_export_curve_json(set, 0, 0, file);
    char *const text = end(file);
    assert_contains(text,
                    "\"entry\": 0, \"friction\": 0.3, \"rolling\": 0.5, \"density_kgpm3\": 2500, "
                    "\"depth\": 1, \"attack_deg\": 0, \"trajectory\": \"pull\", \"packings\": 2,");
    static const char *const keys[] = {
        "progress", "t_s",  "My_Nm",   "My_sd_Nm",   "Fx_N",
        "Fx_sd_N",  "Fz_N", "Fz_sd_N", "carried_kg", "carried_sd_kg"
    };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        char key[32];
        (void)snprintf(key, sizeof key, "\"%s\": [", keys[i]);
        const char *const at = strstr(text, key);
        assert_non_null(at);
        size_t commas = 0;
        for (const char *c = at; *c != ']'; c++) {
            commas += *c == ',';
        }
        assert_int_equal(commas, DIG_CURVE_POINTS - 1);
    }
    free(text);
    dig_curve_set_destroy(set);
}

TEST(the_plot_shows_the_mean_in_every_column)
{
    struct dig_curve_set *const set  = example();
    FILE *const                 file = begin();
    dig_export_curve_plot(set, 0, 0, DIG_CHANNEL_FZ_N, 40, file);
    char *const text = end(file);
    assert_contains(text,
                    "entry 0: friction 0.3, rolling 0.5, 2500 kg/m3; pull, 2 packings\nFz_N\n");
    assert_contains(text, "****************************************\n");
    free(text);
    dig_curve_set_destroy(set);
}

static int free_effects(void **state)
{
    dig_entry_set_destroy(effects);
    return scratch_teardown(state);
}

TESTS_WITH(scratch_setup, free_effects)
