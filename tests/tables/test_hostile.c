// Tests for tables/schema/guard.c, tables/open.c and what reads a table: files that mean harm.
// Every one is refused by every reader and by the writer, and stays as it was.

#include "tests/tables_fixture.h"

#include "tables/merge.h"

#include <sys/stat.h>

static void make_good(void)
{
    struct dig_store *const store = fixture_create("good.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 2.0);
    fixture_put(store, .5, .3, 0, 1, 3.0);
    dig_store_close(store);
}

static enum dig_status pass_over(void *const context, const struct dig_run *const run,
                                 struct dig_error *const error)
{
    (void)context;
    (void)run;
    (void)error;
    return DIG_OK;
}

// By the reader of curves, the reader of runs, the merger and the writer.
static void assert_table_refused(const char *const path, const char *const says)
{
    const struct dig_run_visitor visitor = { pass_over, NULL };
    struct dig_curve_set        *set     = NULL;
    struct dig_entry_set        *effects = NULL;
    struct dig_store            *store   = NULL;
    struct dig_error             error   = { "" };
    assert_int_not_equal(dig_table_list(path, &set, &effects, &error), DIG_OK);
    assert_null(set);
    assert_contains(error.text, path);
    assert_contains(error.text, says);
    enum dig_status status = dig_store_open(path, &store, NULL);
    if (status == DIG_OK) {
        status = dig_store_walk(store, &visitor, NULL);
        struct dig_store_report report;
        if (status == DIG_OK) {
            status = dig_store_check(store, &report, NULL);
        }
        dig_store_close(store);
    }
    assert_int_not_equal(status, DIG_OK);
    const char *const input[] = { path };
    char              out[512];
    (void)snprintf(out, sizeof out, "%s", scratch_path("out.sqlite"));
    if (dig_store_merge(out, 1, input, NULL) == DIG_OK) {
        (void)unlink(out); // what a merge makes of its runs is sound
    }
    assert_false(scratch_exists("out.sqlite.part"));
}

TEST_WITH(a_schema_that_is_not_ours_is_refused_before_anything_of_it_runs, scratch_setup,
          scratch_teardown)
{
    make_good();
    static const char *const hostile[] = {
        "CREATE VIEW photos AS SELECT 1",
        "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM entry; END",
        "CREATE TRIGGER t AFTER UPDATE ON entry BEGIN UPDATE run SET seed = 0; END",
        "CREATE TABLE photos (x)",
        "CREATE INDEX i ON run (abs(seed))",
        "CREATE VIRTUAL TABLE words USING fts5 (x)",
        "ALTER TABLE run ADD COLUMN twice REAL AS (first_s * 2)",
        "ALTER TABLE ground ADD COLUMN more REAL",
        "ALTER TABLE ground RENAME COLUMN rolling TO turning",
        "ALTER TABLE entry RENAME TO e; CREATE VIEW entry AS SELECT * FROM e",
        "DROP TABLE phase; CREATE VIEW phase AS SELECT 1 AS trajectory",
        "ANALYZE",
        "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, 'STRICT', '') "
        "WHERE name = 'ground'",
        "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, 'depth > 0', "
        "'randomblob(9e8) > 0') WHERE name = 'ground'",
        "DROP TABLE seal",
    };
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        const char *const path   = fixture_copy("good.sqlite", "bad.sqlite", hostile[i]);
        size_t            size   = 0;
        char *const       before = scratch_read(path, &size);
        assert_table_refused(path, ": schema: ");

        const struct dig_scene scene = fixture_scene();
        struct dig_store      *store = NULL;
        struct dig_error       error = { "" };
        assert_int_equal(dig_store_create(path, &scene, &store, &error), DIG_EINVAL);
        assert_contains(error.text, ": schema: ");
        size_t      again = 0;
        char *const after = scratch_read(path, &again);
        assert_int_equal(again, size);
        assert_memory_equal(after, before, size);
        free(before);
        free(after);
    }
}

TEST_WITH(what_is_no_number_of_its_column_is_refused, scratch_setup, scratch_teardown)
{
    make_good();
    // A column takes anything once its table is not STRICT; then the schema is made to look right.
#define FORGED(table, change)                                                                      \
    "PRAGMA writable_schema = ON;"                                                                 \
    "UPDATE sqlite_schema SET sql = replace(replace(sql, 'STRICT', ''), 'NOT NULL', '') "          \
    "WHERE name = '" table "';"                                                                    \
    "PRAGMA writable_schema = RESET;" change ";"                                                   \
    "PRAGMA writable_schema = ON;"                                                                 \
    "UPDATE sqlite_schema SET sql = (SELECT sql FROM good.sqlite_schema g WHERE g.name = '" table  \
    "') WHERE name = '" table "'"
    static const struct {
        const char *sql, *says;
    } hostile[] = {
        { FORGED("ground", "UPDATE ground SET friction = 'rough' WHERE id = 1"), "damaged" },
        { FORGED("ground", "UPDATE ground SET density_kgpm3 = NULL WHERE id = 1"), "damaged" },
        { FORGED("ground", "UPDATE ground SET effect = x'00' WHERE id = 1"), "damaged" },
        { FORGED("run", "UPDATE run SET windows = '400 or so'"), "damaged" },
        { FORGED("run", "UPDATE run SET curve = 'none'"), "damaged" },
        { FORGED("run", "UPDATE run SET step_s = x'ff'"), "damaged" },
        { FORGED("entry", "UPDATE entry SET mean = NULL"), "damaged" },
        { FORGED("entry", "UPDATE entry SET packings = 'two' WHERE packings > 1"), "damaged" },
        { FORGED("phase", "UPDATE phase SET vx_mps = 'fast'"), "damaged" },
        { FORGED("trajectory", "UPDATE trajectory SET theta0_rad = NULL"), "damaged" },
        { FORGED("scene", "UPDATE scene SET tooth_m = 'long'"), "damaged" },
    };
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        char sql[2048];
        (void)snprintf(sql, sizeof sql, "ATTACH '%s' AS good; %s", scratch_path("good.sqlite"),
                       hostile[i].sql);
        assert_table_refused(fixture_copy_sealed("good.sqlite", "bad.sqlite", sql),
                             hostile[i].says);
    }
}

TEST_WITH(numbers_out_of_all_bounds_are_refused, scratch_setup, scratch_teardown)
{
    make_good();
    static const struct {
        const char *sql, *says;
    } hostile[] = {
        { "UPDATE entry SET packings = 4294967297 WHERE packings > 1", "packings 1 to" },
        { "UPDATE entry SET mean = zeroblob(100000000)", "too big" },
        { "UPDATE run SET windows = 9223372036854775807", "9223372036854775807 windows" },
        { "UPDATE run SET windows = 1000001, curve = zeroblob(16000016)", "1000001 windows" },
        { "UPDATE run SET step_s = 9e999", "by inf s" },
        { "UPDATE run SET first_s = -9e999", "from -inf s" },
        { "UPDATE ground SET friction = 9e999 WHERE id = 1", "ground.friction: inf" },
        { "UPDATE ground SET magnitude = 9e999, effect = 'cohesion'", "ground.effect" },
        { "UPDATE ground SET attack_rad = 9e999 WHERE id = 1", "attack_rad: inf" },
        { "UPDATE scene SET points = 4294967552", "scene.points: 4294967552, expected 256" },
        { "UPDATE trajectory SET id = id + 4294967296; UPDATE phase SET trajectory = trajectory + "
          "4294967296; UPDATE run SET trajectory = trajectory + 4294967296; UPDATE entry SET "
          "trajectory = trajectory + 4294967296",
          "trajectory: expected rows numbered from 0" },
        { "UPDATE phase SET number = number + 4294967296", "trajectory: expected rows" },
    };
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        assert_table_refused(fixture_copy_sealed("good.sqlite", "bad.sqlite", hostile[i].sql),
                             hostile[i].says);
    }
}

TEST_WITH(texts_that_would_break_an_export_are_refused_where_runs_are_read, scratch_setup,
          scratch_teardown)
{
    make_good();
    static const char *const hostile[] = {
        "UPDATE run SET engine = 'a,b'",
        "UPDATE run SET version = '1' || char(10) || '2'",
        "UPDATE run SET engine = char(27) || '[2J'",
        "UPDATE run SET made_utc = '$(x)'",
    };
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        const struct dig_run_visitor visitor = { pass_over, NULL };
        struct dig_store            *store   = NULL;
        struct dig_error             error   = { "" };
        const char *const path = fixture_copy_sealed("good.sqlite", "bad.sqlite", hostile[i]);
        assert_int_equal(dig_store_open(path, &store, NULL), DIG_OK);
        assert_refused(dig_store_walk(store, &visitor, &error), error, DIG_EINVAL, "run: engine ");
        dig_store_close(store);
    }
    struct dig_store *const    store     = fixture_create("put.sqlite");
    const struct dig_recording recording = fixture_recording(400, 1.0);
    struct dig_run_origin      origin    = fixture_origin(.3, .3, 2500, 0, 0);
    struct dig_error           error     = { "" };
    (void)snprintf(origin.engine, sizeof origin.engine, "a,b");
    assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
    assert_contains(error.text, "run: engine \"a,b\"");
    dig_store_close(store);
}

// Both trees of a table on one page, and a tree that holds itself.
TEST_WITH(pages_that_belong_to_two_or_to_themselves_are_refused, scratch_setup, scratch_teardown)
{
    make_good();
    static const char *const hostile[] = {
        "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = (SELECT rootpage FROM "
        "sqlite_schema WHERE name = 'entry') WHERE name = 'run'",
        "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = 1 WHERE name = 'run'",
        "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = 99999 WHERE name = "
        "'entry'",
    };
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        assert_table_refused(fixture_copy("good.sqlite", "bad.sqlite", hostile[i]), "");
    }
}

static size_t put_word(uint8_t to[], const size_t value)
{
    for (int b = 0; b < 4; b++) {
        to[b] = (uint8_t)(value >> (24 - 8 * b));
    }
    return 4;
}

// Lays a journal of SQLite's beside a table that is to be rolled back, and that says it is one of
// several, listed in the file named: SQLite deletes that list once all are rolled back.
static void lay_journal_of_several(const char *const table, const char *const list)
{
    enum { HEADER = 512, PAGES = 65536 };
    static const uint8_t magic[] = { 0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7 };
    static uint8_t       journal[HEADER + 2 * PAGES];
    size_t               size  = 0;
    uint8_t *const       whole = (uint8_t *)scratch_read(scratch_path(table), &size);
    const size_t         page  = (size_t)whole[16] << 8 | whole[17];
    size_t               sum   = 0;
    memset(journal, 0, sizeof journal);
    memcpy(journal, magic, sizeof magic);
    size_t at = sizeof magic;
    at += put_word(journal + at, 1); // a page
    at += put_word(journal + at, 0);
    at += put_word(journal + at, size / page);
    at += put_word(journal + at, HEADER);
    (void)put_word(journal + at, page);

    at = HEADER + put_word(journal + HEADER, 1);
    memcpy(journal + at, whole, page);
    for (size_t i = page - 200; i > 0 && i < page; i -= 200) {
        sum += whole[i];
    }
    at += page;
    at += put_word(journal + at, sum);

    const size_t length = strlen(list);
    size_t       of     = 0;
    at += put_word(journal + at, 0x40000000 / page + 1);
    for (size_t i = 0; i < length; i++) {
        journal[at++] = (uint8_t)list[i];
        of += (uint8_t)list[i];
    }
    at += put_word(journal + at, length);
    at += put_word(journal + at, of);
    memcpy(journal + at, magic, sizeof magic);
    char name[64];
    (void)snprintf(name, sizeof name, "%s-journal", table);
    (void)scratch_write_bytes(name, journal, at + sizeof magic);
    free(whole);
}

TEST_WITH(a_journal_beside_a_table_deletes_no_other_file, scratch_setup, scratch_teardown)
{
    make_good();
    char list[512];
    (void)snprintf(list, sizeof list, "%s", scratch_write("precious", "mine"));
    struct dig_curve_set *set   = NULL;
    struct dig_error      error = { "" };
    lay_journal_of_several("good.sqlite", list);
    assert_int_not_equal(dig_table_load(scratch_path("good.sqlite"), &set, &error), DIG_OK);
    assert_contains(error.text, "a journal of this table alone");
    assert_true(scratch_exists("precious"));

    const struct dig_scene scene = fixture_scene();
    struct dig_store      *store = NULL;
    lay_journal_of_several("good.sqlite", list);
    assert_int_not_equal(dig_store_create(scratch_path("good.sqlite"), &scene, &store, &error),
                         DIG_OK);
    assert_true(scratch_exists("precious"));

    // What is its own was rolled back.
    dig_curve_set_destroy(fixture_load("good.sqlite"));
}

TEST_WITH(what_stands_beside_a_table_is_not_waited_for_and_no_link_is_followed, scratch_setup,
          scratch_teardown)
{
    make_good();
    static const char *const beside[] = { "good.sqlite-journal", "good.sqlite-wal" };
    const struct dig_scene   scene    = fixture_scene();
    for (size_t i = 0; i < 2; i++) {
        struct dig_curve_set *set   = NULL;
        struct dig_store     *store = NULL;
        if (i == 1) {
            fixture_run_sql("good.sqlite", "PRAGMA journal_mode = WAL");
        }
        assert_int_equal(mkfifo(scratch_path(beside[i]), 0600), 0);
        (void)alarm(20); // ends who waits
        assert_int_not_equal(dig_table_load(scratch_path("good.sqlite"), &set, NULL), DIG_OK);
        (void)alarm(0);
        assert_int_equal(unlink(scratch_path(beside[i])), 0);

        // To an empty file, and to none: SQLite would write the one and make the other.
        (void)scratch_write("precious", "");
        static const char *const targets[] = { "precious", "nowhere" };
        for (size_t t = 0; t < 2; t++) {
            assert_int_equal(symlink(scratch_path(targets[t]), scratch_path(beside[i])), 0);
            if (dig_store_create(scratch_path("good.sqlite"), &scene, &store, NULL) == DIG_OK) {
                const struct dig_run_origin origin    = fixture_origin(.7, .3, 2500, t, 0);
                const struct dig_recording  recording = fixture_recording(400, 1.0);
                assert_int_not_equal(dig_store_put(store, &origin, &recording, NULL), DIG_OK);
                dig_store_close(store);
            }
            struct stat found;
            assert_int_equal(stat(scratch_path("precious"), &found), 0);
            assert_int_equal(found.st_size, 0);
            assert_false(scratch_exists("nowhere"));
            (void)unlink(scratch_path(beside[i]));
        }
    }

    // This one SQLite opens itself.
    struct dig_curve_set *set   = NULL;
    struct dig_error      error = { "" };
    (void)unlink(scratch_path("good.sqlite-shm"));
    assert_int_equal(mkfifo(scratch_path("good.sqlite-shm"), 0600), 0);
    (void)alarm(20);
    assert_int_equal(dig_table_load(scratch_path("good.sqlite"), &set, &error), DIG_EIO);
    (void)alarm(0);
    assert_contains(error.text, "good.sqlite: it, or a journal beside it, cannot be opened");
}

TEST_WITH(no_table_is_made_through_a_link, scratch_setup, scratch_teardown)
{
    const struct dig_scene scene = fixture_scene();
    struct dig_store      *store = NULL;
    struct dig_error       error = { "" };
    assert_int_equal(symlink(scratch_write("nothing", ""), scratch_path("empty.sqlite")), 0);
    assert_int_equal(symlink(scratch_path("elsewhere"), scratch_path("lost.sqlite")), 0);
    assert_refused(dig_store_create(scratch_path("empty.sqlite"), &scene, &store, &error), error,
                   DIG_EINVAL, "a link to an empty file");
    assert_int_equal(dig_store_create(scratch_path("lost.sqlite"), &scene, &store, &error),
                     DIG_EIO);
    struct stat found;
    assert_int_equal(stat(scratch_path("nothing"), &found), 0);
    assert_int_equal(found.st_size, 0);
    assert_false(scratch_exists("elsewhere"));

    // To a table it is as good as the table's name.
    dig_store_close(fixture_create("whole.sqlite"));
    assert_int_equal(symlink(scratch_path("whole.sqlite"), scratch_path("link.sqlite")), 0);
    dig_store_close(fixture_create("link.sqlite"));
}

// Debian's SQLite takes a name that begins with "file:" for a URI, which may choose another file
// and another file system than the guarded one.
TEST_WITH(a_table_is_the_file_of_its_very_name, scratch_setup, scratch_teardown)
{
    static const char *const names[] = { "file:good.sqlite", "file:good.sqlite?vfs=unix",
                                         "file:good.sqlite?mode=memory", ":memory:" };
    make_good();
    char before[512];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(scratch_dir), 0);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct dig_curve_set  *set   = NULL;
        struct dig_store      *store = NULL;
        const struct dig_scene scene = fixture_scene();
        assert_int_equal(dig_table_load(names[i], &set, NULL), DIG_EIO); // it is not there
        assert_int_equal(dig_store_create(names[i], &scene, &store, NULL), DIG_OK);
        fixture_put(store, .9, .9, 0, 0, 5.0);
        dig_store_close(store);
        assert_int_equal(dig_table_load(names[i], &set, NULL), DIG_OK);
        assert_int_equal(set->entries, 1);
        assert_close(set->gravel[0].value[DIG_AXIS_FRICTION], .9, 0.0);
        dig_curve_set_destroy(set);
    }
    assert_int_equal(chdir(before), 0);
    struct dig_curve_set *const good = fixture_load("good.sqlite");
    assert_int_equal(good->entries, 2);
    dig_curve_set_destroy(good);
}
