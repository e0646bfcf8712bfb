// Tests for files/text/csv.c: files without end, and files that change while they are read.

#include "files/text/csv.h"

#include "tests/scratch.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

static const struct dig_csv_column columns[] = { { .name = "t_s" },
                                                 { .name = "y", .optional = true } };

static void rows_without_end_are_refused_by_their_line(void **state)
{
    (void)state;
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
    assert_int_equal(dig_csv_read(scratch_path("long.csv"), 2, columns, &csv, &error), DIG_EINVAL);
    assert_contains(error.text, "long.csv:4194306: a row after 4194304 others, expected fewer");
    assert_int_equal(csv.rows, 42);
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

static void a_file_that_changes_while_it_is_read_is_rows_or_a_refusal(void **state)
{
    (void)state;
    const char *const path   = scratch_write("moving.csv", "t_s\n1\n");
    struct writer     writer = { .path = path };
    pthread_t         thread;
    assert_int_equal(pthread_create(&thread, NULL, write_again_and_again, &writer), 0);
    for (int i = 0; i < 300; i++) {
        struct dig_csv        csv    = { 0 };
        struct dig_error      error  = { "" };
        const enum dig_status status = dig_csv_read(path, 2, columns, &csv, &error);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_without_end_are_refused_by_their_line),
        cmocka_unit_test(a_file_that_changes_while_it_is_read_is_rows_or_a_refusal),
    };
    return cmocka_run_group_tests_name("csv", tests, scratch_setup, scratch_teardown);
}
