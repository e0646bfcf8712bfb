// Tests for tables/store.c, put.c, runs.c, check.c and schema.c

#include "tables/store.h"

#include "tests/tables_fixture.h"

#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

TEST(a_new_table_says_what_it_is)
{
    dig_store_close(fixture_create("new.sqlite"));
    assert_int_equal(fixture_ask("new.sqlite", "PRAGMA application_id"), 0x44494754);
    assert_int_equal(fixture_ask("new.sqlite", "PRAGMA user_version"), 4);
    assert_int_equal(fixture_ask("new.sqlite", "SELECT count(*) FROM scene"), 1);
    assert_int_equal(fixture_ask("new.sqlite", "SELECT count(*) FROM trajectory"), 2);
    assert_int_equal(fixture_ask("new.sqlite", "SELECT count(*) FROM phase"), 3);
    assert_int_equal(fixture_ask("new.sqlite",
                                 "SELECT count(*) FROM pragma_table_list WHERE schema = "
                                 "'main' AND NOT strict AND name NOT LIKE 'sqlite_%'"),
                     0);
    assert_false(scratch_exists("new.sqlite-wal"));
    assert_false(scratch_exists("new.sqlite-journal"));
}

struct seen {
    size_t         runs;
    struct dig_run last;
    float          first_value;
};

static enum dig_status see(void *const context, const struct dig_run *const run,
                           struct dig_error *const error)
{
    (void)error;
    struct seen *const seen = context;
    seen->runs++;
    seen->last        = *run;
    seen->last.value  = NULL;
    seen->first_value = run->value[DIG_CHANNEL_FZ_N * run->windows];
    return DIG_OK;
}

static bool has(struct dig_store *const store, const struct dig_run_origin key)
{
    bool there = false;
    assert_int_equal(dig_store_has(store, &key, &there, NULL), DIG_OK);
    return there;
}

TEST(a_run_comes_back_with_where_it_came_from)
{
    struct dig_store *store = fixture_create("run.sqlite");
    fixture_put(store, .3, .5, 7, 1, 0.75);
    assert_true(has(store, fixture_origin(.3, .5, 2500.0, 7, 1)));
    assert_false(has(store, fixture_origin(.3, .5, 2500.0, 7, 0)));
    assert_false(has(store, fixture_origin(.3, .5, 2500.0, 6, 1)));
    assert_false(has(store, fixture_varied(fixture_origin(.3, .5, 2500.0, 7, 1), "cohesion", 1)));
    dig_store_close(store);

    assert_int_equal(dig_store_open(scratch_path("run.sqlite"), &store, NULL), DIG_OK);
    struct seen                  seen    = { .runs = 0 };
    const struct dig_run_visitor visitor = { see, &seen };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    assert_int_equal(seen.runs, 1);
    assert_close(seen.last.origin.gravel.value[DIG_AXIS_ROLLING], .5, 0.0);
    assert_int_equal(seen.last.origin.packing, 7);
    assert_int_equal(seen.last.origin.trajectory, 1);
    assert_true(seen.last.origin.seed == 4611686018427387912U);
    assert_string_equal(seen.last.origin.engine, "test");
    assert_string_equal(seen.last.origin.version, "1.2");
    assert_int_equal(seen.last.origin.grains, 12);
    assert_close(seen.last.origin.wall_s, 0.5, 0.0);
    assert_int_equal(seen.last.windows, 200);
    assert_close(seen.last.first_s, 0.0025, 0.0);
    assert_close(seen.last.step_s, 0.005, 1e-15);
    assert_close((double)seen.first_value, -2.25, 0.0);
    dig_store_close(store);
}

TEST(a_run_is_stored_once_and_a_bad_one_not_at_all)
{
    struct dig_store           *store     = fixture_create("once.sqlite");
    struct dig_error            error     = { "" };
    const struct dig_run_origin origin    = fixture_origin(.3, .5, 2500.0, 0, 0);
    struct dig_recording        recording = fixture_recording(400, 1.0);
    assert_int_equal(dig_store_put(store, &origin, &recording, NULL), DIG_OK);
    assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "packing 0 of friction 0.3, rolling 0.5, 2500 kg/m3 on pull is "
                                "there already");

    const struct dig_run_origin second = fixture_origin(.9, .5, 2500.0, 1, 0);
    recording.row[17].My_Nm            = (double)NAN;
    assert_int_equal(dig_store_put(store, &second, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "row 18: expected finite");
    recording = fixture_recording(400, 1.0);
    recording.row[17].t_s += 0.001;
    assert_int_equal(dig_store_put(store, &second, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "row 18: t_s 0.0885, expected evenly spaced");
    recording      = fixture_recording(400, 1.0);
    recording.rows = 1;
    assert_int_equal(dig_store_put(store, &second, &recording, &error), DIG_EINVAL);
    dig_store_close(store);
    assert_int_equal(fixture_ask("once.sqlite", "SELECT count(*) FROM run"), 1);
    assert_int_equal(fixture_ask("once.sqlite", "SELECT count(*) FROM ground"), 1);
    assert_int_equal(fixture_ask("once.sqlite", "SELECT count(*) FROM entry"), 1);
}

TEST(runs_put_together_are_stored_together_or_not_at_all)
{
    struct dig_store           *store     = fixture_create("together.sqlite");
    const struct dig_run_origin before    = fixture_origin(.3, .5, 2500.0, 0, 0);
    const struct dig_run_origin first     = fixture_origin(.3, .5, 2500.0, 1, 0);
    const struct dig_run_origin second    = fixture_origin(.9, .5, 2500.0, 1, 0);
    const struct dig_recording  recording = fixture_recording(400, 1.0);
    assert_int_equal(dig_store_put(store, &before, &recording, NULL), DIG_OK);

    // Closed without a commit, as a crash would.
    assert_int_equal(dig_store_begin(store, NULL), DIG_OK);
    assert_int_equal(dig_store_put(store, &first, &recording, NULL), DIG_OK);
    assert_int_equal(dig_store_put(store, &first, &recording, NULL), DIG_EINVAL);
    assert_int_equal(dig_store_put(store, &second, &recording, NULL), DIG_OK);
    assert_true(has(store, second));
    dig_store_close(store);
    assert_int_equal(fixture_ask("together.sqlite", "SELECT count(*) FROM run"), 1);
    assert_int_equal(fixture_ask("together.sqlite", "SELECT count(*) FROM ground"), 1);

    store = fixture_create("together.sqlite");
    assert_int_equal(dig_store_begin(store, NULL), DIG_OK);
    assert_int_equal(dig_store_put(store, &first, &recording, NULL), DIG_OK);
    assert_int_equal(dig_store_put(store, &first, &recording, NULL), DIG_EINVAL);
    assert_int_equal(dig_store_put(store, &second, &recording, NULL), DIG_OK);
    assert_int_equal(dig_store_commit(store, NULL), DIG_OK);
    dig_store_close(store);
    assert_int_equal(fixture_ask("together.sqlite", "SELECT count(*) FROM run"), 3);
}

TEST(another_scene_is_refused_and_both_are_named)
{
    dig_store_close(fixture_create("scene.sqlite"));
    size_t            before_size = 0, after_size = 0;
    char *const       before = scratch_read(scratch_path("scene.sqlite"), &before_size);
    struct dig_scene  other  = fixture_scene();
    struct dig_error  error  = { "" };
    struct dig_store *store  = NULL;
    other.material.young_Pa  = 6e6;
    (void)snprintf(other.name, sizeof other.name, "stiffer");
    assert_int_equal(dig_store_create(scratch_path("scene.sqlite"), &other, &store, &error),
                     DIG_EINVAL);
    assert_null(store);
    assert_contains(error.text, "holds \"tub\" (");
    assert_contains(error.text, "not \"stiffer\" (");
    char *const after = scratch_read(scratch_path("scene.sqlite"), &after_size);
    assert_int_equal(before_size, after_size);
    assert_memory_equal(before, after, after_size);
    free(before);
    free(after);
}

TEST(what_cannot_become_a_table_is_left_as_it_was)
{
    struct dig_scene  scene = fixture_scene();
    struct dig_error  error = { "" };
    struct dig_store *store = NULL;
    assert_refused(
        dig_store_create(scratch_write("text.sqlite", "no database at all, just a text file\n"),
                         &scene, &store, &error),
        error, DIG_EINVAL, "text.sqlite: not a digsight table");
    size_t size = 0;
    char  *text = scratch_read(scratch_path("text.sqlite"), &size);
    assert_string_equal(text, "no database at all, just a text file\n");
    free(text);

    fixture_run_sql("other.sqlite", "CREATE TABLE photos (id INTEGER)");
    assert_refused(dig_store_create(scratch_path("other.sqlite"), &scene, &store, &error), error,
                   DIG_EINVAL, "other.sqlite: not a digsight table (application_id 0");

    dig_store_close(fixture_create("newer.sqlite"));
    fixture_run_sql("newer.sqlite", "PRAGMA user_version = 5");
    assert_refused(dig_store_create(scratch_path("newer.sqlite"), &scene, &store, &error), error,
                   DIG_ESCHEMA, "newer.sqlite: user_version: table format 5, expected 4");

    assert_int_equal(
        dig_store_create(scratch_path("no/such/folder.sqlite"), &scene, &store, &error), DIG_EIO);
    scene.bucket.points = 1;
    assert_int_equal(dig_store_create(scratch_path("bad.sqlite"), &scene, &store, &error),
                     DIG_EINVAL);
    assert_false(scratch_exists("bad.sqlite"));
    assert_null(store);
}

TEST(a_file_not_yet_filled_becomes_a_table)
{
    (void)scratch_write("empty.sqlite", "");
    dig_store_close(fixture_create("empty.sqlite"));
    assert_int_equal(fixture_ask("empty.sqlite", "SELECT count(*) FROM scene"), 1);
}

// Laws and beds stand in the canonical text behind the trajectories.
TEST(a_scene_that_is_not_plain_has_a_table_too)
{
    struct dig_scene  scene = fixture_scene();
    struct dig_store *store = NULL;
    struct dig_error  error = { "" };
    scene.laws.rolling      = DIG_ROLLING_NONE;
    scene.bed.preload_Pa    = 500.0;
    assert_ok(dig_store_create(scratch_path("bed.sqlite"), &scene, &store, &error), error);
    dig_store_close(store);
    assert_ok(dig_store_open(scratch_path("bed.sqlite"), &store, &error), error);
    dig_store_close(store);
}

TEST(there_is_one_writer_at_a_time)
{
    struct dig_store      *first  = fixture_create("lock.sqlite");
    struct dig_store      *second = NULL;
    const struct dig_scene scene  = fixture_scene();
    struct dig_error       error  = { "" };
    assert_refused(dig_store_create(scratch_path("lock.sqlite"), &scene, &second, &error), error,
                   DIG_EIO, "another process is adding to this table");
    assert_int_equal(dig_store_open(scratch_path("lock.sqlite"), &second, NULL), DIG_OK);
    fixture_put(first, .3, .3, 0, 0, 1.0); // while a reader has it open
    dig_store_close(second);
    dig_store_close(first);
    assert_int_equal(dig_store_create(scratch_path("lock.sqlite"), &scene, &second, NULL), DIG_OK);
    dig_store_close(second);
}

// Killed at moments spread over its work, a writer leaves whole runs with their entries, and the
// next one goes on behind the last of them.
TEST(a_killed_writer_leaves_whole_runs_only)
{
    dig_store_close(fixture_create("killed.sqlite"));
    for (int round = 1; round <= 8; round++) {
        const sqlite3_int64 before = fixture_ask("killed.sqlite", "SELECT count(*) FROM run");
        int                 told[2]; // a byte for each run stored
        assert_int_equal(pipe(told), 0);
        const pid_t child = fork();
        if (child == 0) {
            struct dig_store *const store = fixture_create("killed.sqlite");
            for (size_t k = (size_t)before;; k++) {
                fixture_put(store, .3, .3, k, 0, (double)k);
                (void)!write(told[1], "r", 1);
            }
        }
        assert_true(child > 0);
        (void)close(told[1]);
        char one = ' ';
        assert_int_equal(read(told[0], &one, 1), 1);
        const struct timespec some = { .tv_nsec = 1300000L * round };
        (void)nanosleep(&some, NULL);
        assert_int_equal(kill(child, SIGKILL), 0);
        assert_int_equal(waitpid(child, NULL, 0), child);
        (void)close(told[0]);

        struct dig_store *const store = fixture_create("killed.sqlite");
        const sqlite3_int64     after = fixture_ask("killed.sqlite", "SELECT count(*) FROM run");
        assert_true(after > before);
        struct dig_store_report report = { .entries = 0 };
        struct dig_error        error  = { "" };
        assert_ok(dig_store_check(store, &report, &error), error);
        assert_int_equal(report.runs, after);
        dig_store_close(store);
    }
    assert_int_equal(fixture_ask("killed.sqlite", "SELECT count(*) - max(packing) FROM run"), 1);
}

TEST(the_check_counts_holes_and_finds_entries_that_lie)
{
    struct dig_store *store = fixture_create("check.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 2.0);
    fixture_put(store, .5, .5, 0, 0, 3.0);
    fixture_put(store, .9, .3, 0, 0, 3.0);
    fixture_put(store, .9, .3, 1, 0, 3.5);
    struct dig_store_report report = { .entries = 0 };
    assert_int_equal(dig_store_check(store, &report, NULL), DIG_OK);
    assert_int_equal(report.points, 3);
    assert_int_equal(report.entries, 3);
    assert_int_equal(report.runs, 5);
    assert_int_equal(report.holes, 3);
    assert_int_equal(report.incomplete, 1);
    dig_store_close(store);

    static const char *const lies[] = {
        "UPDATE entry SET mean = (SELECT mean FROM entry WHERE ground = 2) WHERE ground = 1",
        "UPDATE entry SET spread = mean WHERE ground = 3",
        "UPDATE entry SET packings = 3 WHERE ground = 3",
        "DELETE FROM run WHERE ground = 2",
    };
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        struct dig_error error = { "" };
        report                 = (struct dig_store_report){ .runs = 42 };
        (void)fixture_copy_sealed("check.sqlite", "lie.sqlite", lies[i]);
        assert_int_equal(dig_store_open(scratch_path("lie.sqlite"), &store, NULL), DIG_OK);
        assert_int_equal(dig_store_check(store, &report, &error), DIG_EINVAL);
        assert_contains(error.text, "lie.sqlite: entry: friction");
        assert_contains(error.text, "expected");
        assert_int_equal(report.runs, 42);
        dig_store_close(store);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
