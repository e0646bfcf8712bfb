// Tests for core/part.c, and for those who write with it: a link where their file should go.

#include "core/part.h"
#include "files/text/whole.h"
#include "tables/merge.h"
#include "tests/tables_fixture.h"

#include <fcntl.h>
#include <sys/stat.h>

static void assert_kept(void)
{
    size_t      size = 0;
    char *const kept = scratch_read(scratch_path("precious"), &size);
    assert_int_equal(size, 5);
    assert_memory_equal(kept, "mine\n", 5);
    free(kept);
}

static void lay_link(const char *const name)
{
    (void)scratch_write("precious", "mine\n");
    (void)unlink(scratch_path(name));
    assert_int_equal(symlink(scratch_path("precious"), scratch_path(name)), 0);
}

TEST(a_link_is_replaced_not_followed)
{
    lay_link("a.part");
    FILE *const file = dig_part_open(scratch_path("a.part"));
    assert_non_null(file);
    assert_true(fputs("new", file) >= 0);
    assert_int_equal(fclose(file), 0);
    assert_kept();
    struct stat found;
    assert_int_equal(lstat(scratch_path("a.part"), &found), 0);
    assert_true(S_ISREG(found.st_mode));
    assert_int_equal(found.st_size, 3);
}

TEST(what_was_left_there_is_replaced_and_a_folder_is_not)
{
    (void)scratch_write("b.part", "of a killed program, and longer");
    FILE *const file = dig_part_open(scratch_path("b.part"));
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
    struct stat found;
    assert_int_equal(stat(scratch_path("b.part"), &found), 0);
    assert_int_equal(found.st_size, 0);
    assert_int_equal(mkdir(scratch_path("c.part"), 0700), 0);
    assert_null(dig_part_open(scratch_path("c.part")));
    assert_int_equal(rmdir(scratch_path("c.part")), 0);
    assert_null(dig_part_open(scratch_path("no/such/d.part")));
}

TEST(an_output_file_does_not_write_through_a_link_at_its_part)
{
    struct dig_out   out;
    struct dig_error error = { "" };
    lay_link("out.csv.part");
    assert_int_equal(dig_out_open(&out, scratch_path("out.csv"), &error), DIG_OK);
    assert_true(fputs("new\n", out.file) >= 0);
    assert_int_equal(dig_out_commit(&out, &error), DIG_OK);
    assert_kept();
    struct stat found;
    assert_int_equal(lstat(scratch_path("out.csv"), &found), 0);
    assert_true(S_ISREG(found.st_mode));
}

TEST(a_pipe_is_written_where_somebody_reads_it_and_not_waited_for_otherwise)
{
    struct dig_out   out   = { 0 };
    struct dig_error error = { "" };
    assert_int_equal(mkfifo(scratch_path("pipe"), 0600), 0);
    (void)alarm(5); // ends who waits
    assert_int_equal(dig_out_open(&out, scratch_path("pipe"), &error), DIG_EIO);
    (void)alarm(0);
    assert_contains(error.text, "pipe: ");

    const int fd = open(scratch_path("pipe"), O_RDONLY | O_NONBLOCK);
    char      read_back[8];
    assert_int_equal(dig_out_open(&out, scratch_path("pipe"), &error), DIG_OK);
    assert_true(fputs("new", out.file) >= 0);
    assert_int_equal(dig_out_commit(&out, &error), DIG_OK);
    assert_int_equal(read(fd, read_back, sizeof read_back), 3);
    assert_int_equal(close(fd), 0);
}

TEST(nor_does_a_merged_table)
{
    struct dig_store *const store = fixture_create("in.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    dig_store_close(store);
    struct dig_error error = { "" };
    char             out[512], in[512];
    (void)snprintf(out, sizeof out, "%s", scratch_path("merged.sqlite"));
    (void)snprintf(in, sizeof in, "%s", scratch_path("in.sqlite"));
    const char *const input[] = { in };
    lay_link("merged.sqlite.part");
    assert_ok(dig_store_merge(out, 1, input, &error), error);
    assert_kept();
}

TESTS_WITH(scratch_setup, scratch_teardown)
