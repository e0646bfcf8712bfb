// Tests for files/text/csv.c: files without end, and files that change while they are read.

#include "files/text/csv.h"

#include "tests/scratch.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <sys/resource.h>

static const struct dig_csv_column columns[] = { { .name = "t_s" },
                                                 { .name = "y", .optional = true } };

TEST(rows_without_end_are_refused_by_their_line)
{
    enum { ROWS = (1 << 22) + 10 };
    FILE *const file = fopen(scratch_path("long.csv"), "w");
    assert_non_null(file);
    (void)fputs("t_s\n", file);
    for (int i = 0; i < ROWS; i++) {
        (void)fputs("1\n", file);
    }
    assert_int_equal(fclose(file), 0);
    struct dig_csv   csv   = { .rows = 42 };
    struct dig_error error = { "" };
    assert_refused(
        dig_csv_read(scratch_path("long.csv"), DIG_CSV_REFUSE_OTHERS, 2, columns, &csv, &error),
        error, DIG_EINVAL, "long.csv:4194306: a row after 4194304 others, expected fewer");
    assert_int_equal(csv.rows, 42);
}

// A file of holes is as long as it says and takes no room on the disk; an archive brings it along.
TEST(a_line_without_end_is_no_header_and_takes_no_memory)
{
    const char *const path = scratch_write("holes.csv", "# a comment");
    assert_int_equal(truncate(path, 512 << 20), 0);
    struct rusage before, after;
    assert_int_equal(getrusage(RUSAGE_SELF, &before), 0);
    assert_false(dig_csv_has(path, "t_s"));
    assert_int_equal(getrusage(RUSAGE_SELF, &after), 0);
    assert_true(after.ru_maxrss - before.ru_maxrss < 64 * 1024); // kB
}

TEST(the_header_is_found_behind_comments_of_any_length)
{
    enum { LONG = 20000 };
    static char text[LONG + 200] = "#";
    memset(text + 1, 'x', LONG);
    (void)snprintf(text + LONG, sizeof text - LONG, ",y\n\n  # more\r\nt_s, y\r\n1,2\n");
    assert_true(dig_csv_has(scratch_write("long.csv", text), "y"));
    assert_false(dig_csv_has(scratch_path("long.csv"), "x"));
    assert_true(dig_csv_has(scratch_write("mark.csv", "\xef\xbb\xbft_s"), "t_s"));
    assert_false(dig_csv_has(scratch_write("none.csv", "#t_s"), "t_s"));
}

// Writes the file anew, longer, shorter, empty and broken, until it is told to stop.
struct writer {
    const char *path;
    atomic_bool stop;
};

static void *write_again_and_again(void *const context)
{
    struct writer *const w = context;
    for (unsigned turn = 0; !atomic_load(&w->stop); turn++) {
        FILE *const file = fopen(w->path, "w"); // in place: the reader sees it grow and shrink
        if (file == NULL) {
            continue;
        }
        (void)fputs(turn % 7 == 3 ? "t_s,t_s\n" : "t_s,y\n", file);
        for (unsigned i = 0; i < turn % 5 * 3000; i++) {
            (void)fprintf(file, "%u,%u.5\n", i, i);
        }
        (void)fclose(file);
    }
    return NULL;
}

TEST(a_file_that_changes_while_it_is_read_is_rows_or_a_refusal)
{
    const char *const path   = scratch_write("moving.csv", "t_s\n1\n");
    struct writer     writer = { .path = path };
    pthread_t         thread;
    assert_int_equal(pthread_create(&thread, NULL, write_again_and_again, &writer), 0);
    for (int i = 0; i < 300; i++) {
        struct dig_csv        csv   = { 0 };
        struct dig_error      error = { "" };
        const enum dig_status status =
            dig_csv_read(path, DIG_CSV_REFUSE_OTHERS, 2, columns, &csv, &error);
        (void)dig_csv_has(path, "y");
        if (status == DIG_OK) {
            assert_true(csv.rows >= 1 && isfinite(csv.value[0]));
        } else {
            assert_null(csv.value);
            assert_contains(error.text, "moving.csv");
        }
        dig_csv_finish(&csv);
    }
    atomic_store(&writer.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
}

TESTS_WITH(scratch_setup, scratch_teardown)
