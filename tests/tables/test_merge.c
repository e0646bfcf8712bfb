// Tests for tables/merge.c

#include "tables/merge.h"

#include "tables/export.h"
#include "tests/tables_fixture.h"

#include <sqlite3.h>

enum { RUNS = 24, PARTS = 3 };

// The i-th run of a table: gravels, effects, packings and trajectories all vary.
static void put(struct dig_store *const store, const size_t i, const double my_Nm,
                const char *const made_utc)
{
    static const double   friction[] = { .9, .3, .5 };
    struct dig_run_origin origin =
        fixture_origin(friction[i % 3], .5, 2500.0, i / 6 % 2, i / 3 % 2);
    if (i >= RUNS / 2) {
        origin = fixture_varied(origin, i % 2 ? "cohesion" : "layering", i % 2 ? 5.0 : -1.0);
    }
    (void)snprintf(origin.made_utc, sizeof origin.made_utc, "%s", made_utc);
    fixture_put_run(store, origin, my_Nm);
}

static double moment_of(const size_t i)
{
    return 1.0 + 0.01 * (double)(i * i);
}

// One table in one go, and the same runs dealt out to PARTS files, some of them to two.
static void make_tables(void)
{
    struct dig_store *const  whole = fixture_create("whole.sqlite");
    struct dig_store        *part[PARTS];
    static const char *const name[PARTS] = { "a.sqlite", "b.sqlite", "c.sqlite" };
    for (size_t p = 0; p < PARTS; p++) {
        part[p] = fixture_create(name[p]);
    }
    for (size_t i = 0; i < RUNS; i++) {
        put(whole, i, moment_of(i), "2026-01-01T00:00:00Z");
        put(part[i * 7 % PARTS], i, moment_of(i), "2026-01-01T00:00:00Z");
        if (i % 5 == 0) {
            put(part[(i * 7 + 1) % PARTS], i, moment_of(i), "2026-01-02T00:00:00Z");
        }
    }
    dig_store_close(whole);
    for (size_t p = 0; p < PARTS; p++) {
        dig_store_close(part[p]);
    }
}

static char *merged(const char *const out, const size_t inputs, const char *const input[const],
                    size_t *const size)
{
    char             copy[PARTS][512];
    const char      *path[PARTS];
    struct dig_error error = { "" };
    for (size_t i = 0; i < inputs; i++) {
        (void)snprintf(copy[i], sizeof copy[i], "%s", scratch_path(input[i]));
        path[i] = copy[i];
    }
    (void)unlink(scratch_path(out));
    assert_ok(dig_store_merge(scratch_path(out), inputs, path, &error), error);
    return scratch_read(scratch_path(out), size);
}

static char *runs_of(const char *const name)
{
    struct dig_store *store = NULL;
    size_t            size  = 0;
    assert_int_equal(dig_store_open(scratch_path(name), &store, NULL), DIG_OK);
    struct dig_store_report report = { .runs = 0 };
    struct dig_error        error  = { "" };
    assert_ok(dig_store_check(store, &report, &error), error);
    assert_int_equal(report.runs, RUNS);
    FILE *const file = fopen(scratch_path("runs.csv"), "wb");
    assert_non_null(file);
    assert_int_equal(dig_export_runs(store, file, NULL), DIG_OK);
    assert_int_equal(fclose(file), 0);
    dig_store_close(store);
    return scratch_read(scratch_path("runs.csv"), &size);
}

TEST_WITH(parts_in_any_order_give_the_bytes_of_the_whole, scratch_setup, scratch_teardown)
{
    make_tables();
    static const char *const order[][PARTS] = {
        { "a.sqlite", "b.sqlite", "c.sqlite" },
        { "c.sqlite", "b.sqlite", "a.sqlite" },
        { "b.sqlite", "a.sqlite", "c.sqlite" },
    };
    static const char *const one[] = { "whole.sqlite" };
    size_t                   size = 0, other_size = 0;
    char *const              whole = merged("out.sqlite", 1, one, &size);
    char *const              runs  = runs_of("whole.sqlite");
    for (size_t i = 0; i < 3; i++) {
        char *const bytes = merged("out.sqlite", PARTS, order[i], &other_size);
        assert_int_equal(other_size, size);
        assert_memory_equal(bytes, whole, size);
        free(bytes);
        char *const text = runs_of("out.sqlite");
        assert_string_equal(text, runs);
        free(text);
    }
    free(whole);
    free(runs);
    assert_false(scratch_exists("out.sqlite.part"));
}

// Merging what was merged, or a part of it again, changes nothing.
TEST_WITH(what_is_there_already_is_not_there_twice, scratch_setup, scratch_teardown)
{
    make_tables();
    static const char *const all[]   = { "a.sqlite", "b.sqlite", "c.sqlite" };
    static const char *const again[] = { "first.sqlite", "b.sqlite", "first.sqlite" };
    size_t                   size = 0, other_size = 0;
    char *const              first  = merged("first.sqlite", PARTS, all, &size);
    char *const              second = merged("second.sqlite", PARTS, again, &other_size);
    assert_int_equal(other_size, size);
    assert_memory_equal(first, second, size);
    free(first);
    free(second);

    const char *const one     = scratch_path("first.sqlite");
    const char *const twice[] = { one, one };
    assert_int_equal(dig_store_merge(scratch_path("third.sqlite"), 2, twice, NULL), DIG_OK);
}

static void refuse(const char *const second, const enum dig_status status, const char *const says)
{
    char first[512], other[512], out[512];
    (void)snprintf(first, sizeof first, "%s", scratch_path("a.sqlite"));
    (void)snprintf(other, sizeof other, "%s", scratch_path(second));
    (void)snprintf(out, sizeof out, "%s", scratch_path("refused.sqlite"));
    const char *const input[] = { first, other };
    struct dig_error  error   = { "" };
    assert_int_equal(dig_store_merge(out, 2, input, &error), status);
    assert_contains(error.text, says);
    assert_false(scratch_exists("refused.sqlite"));
    assert_false(scratch_exists("refused.sqlite.part"));
}

// SQLite opens files by this. Another takes the place of "a.sqlite" before that is opened again.
static sqlite3_vfs swapper;
static int (*open_as_ever)(sqlite3_vfs *, const char *, sqlite3_file *, int, int *);
static int  opened;
static char watched[512], usurper[512];

static int open_and_swap(sqlite3_vfs *const vfs, const char *const path, sqlite3_file *const file,
                         const int flags, int *const got)
{
    if (path != NULL && strcmp(path, watched) == 0 && ++opened == 2) {
        assert_int_equal(rename(usurper, watched), 0);
    }
    return open_as_ever(vfs, path, file, flags, got);
}

TEST_WITH(a_table_is_merged_as_it_was_checked_whoever_takes_its_name, scratch_setup,
          scratch_teardown)
{
    make_tables();
    static const char *const a[]  = { "a.sqlite" };
    size_t                   size = 0, again = 0;
    char *const              before = merged("before.sqlite", 1, a, &size);
    sqlite3_vfs *const       ours   = sqlite3_vfs_find(NULL);
    (void)snprintf(watched, sizeof watched, "%s", scratch_path("a.sqlite"));
    (void)snprintf(usurper, sizeof usurper, "%s", scratch_path("b.sqlite"));
    swapper       = *ours;
    swapper.zName = "swapper";
    open_as_ever  = ours->xOpen;
    swapper.xOpen = open_and_swap;
    assert_int_equal(sqlite3_vfs_register(&swapper, 1), SQLITE_OK);
    char *const after = merged("after.sqlite", 1, a, &again);
    assert_int_equal(sqlite3_vfs_unregister(&swapper), SQLITE_OK);
    assert_true(opened > 0);
    assert_int_equal(again, size);
    assert_memory_equal(after, before, size);
    free(before);
    free(after);
}

TEST_WITH(what_differs_or_does_not_belong_is_refused, scratch_setup, scratch_teardown)
{
    make_tables();
    struct dig_store *store = fixture_create("liar.sqlite");
    put(store, 0, 7.0, "2026-01-01T00:00:00Z");
    dig_store_close(store);
    refuse("liar.sqlite", DIG_EINVAL,
           "liar.sqlite: run: packing 0 of friction 0.9, rolling 0.5, 2500 kg/m3 on pull differs");
    (void)fixture_copy_sealed("a.sqlite", "build.sqlite", "UPDATE run SET version = 'other'");
    refuse("build.sqlite", DIG_EINVAL, "differs from another input's");
    (void)fixture_copy("a.sqlite", "old.sqlite", "PRAGMA user_version = 1");
    refuse("old.sqlite", DIG_ESCHEMA, "table format 1, expected 4");
    refuse("absent.sqlite", DIG_EIO, "absent.sqlite: No such file");

    struct dig_scene other  = fixture_scene();
    other.material.young_Pa = 6e6;
    assert_int_equal(dig_store_create(scratch_path("scene.sqlite"), &other, &store, NULL), DIG_OK);
    dig_store_close(store);
    refuse("scene.sqlite", DIG_EINVAL, "scene.sqlite: scene: holds \"tub\" (");

    const char *const input[] = { scratch_path("a.sqlite") };
    struct dig_error  error   = { "" };
    assert_int_equal(dig_store_merge(scratch_path("b.sqlite"), 1, input, &error), DIG_EINVAL);
    assert_contains(error.text, "b.sqlite: exists, expected a new file");
    assert_int_equal(dig_store_merge(scratch_path("no/b.sqlite"), 1, input, &error), DIG_EIO);
}
