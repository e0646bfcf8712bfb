// Tests for files/text/whole.c: what is written whole or not at all

#include "files/text/whole.h"

#include "tests/scratch.h"

#include <fcntl.h>
#include <sys/stat.h>

TEST(a_file_that_cannot_be_finished_leaves_the_old_one_whole)
{
    struct dig_error  error = { "" };
    struct dig_out    out;
    const char *const path = scratch_write("kept.txt", "old");
    assert_int_equal(dig_out_open(&out, path, &error), DIG_OK);
    (void)fputs("new", out.file);
    dig_out_cancel(&out);
    dig_out_cancel(&out);
    size_t size = 0;
    char  *text = scratch_read(path, &size);
    assert_string_equal(text, "old");
    free(text);
    assert_false(scratch_exists("kept.txt.part"));

    assert_int_equal(dig_out_open(&out, path, &error), DIG_OK);
    (void)fputs("new", out.file);
    assert_int_equal(dig_out_commit(&out, &error), DIG_OK);
    dig_out_cancel(&out);
    text = scratch_read(path, &size);
    assert_string_equal(text, "new");
    free(text);

    assert_int_equal(dig_out_open(&out, scratch_path("no/such/folder.csv"), &error), DIG_EIO);
    assert_contains(error.text, "No such file");

    // A folder that turns up under the name meanwhile: rename must fail, and the part go.
    assert_int_equal(dig_out_open(&out, scratch_path("folder"), &error), DIG_OK);
    assert_int_equal(mkdir(scratch_path("folder"), 0777), 0);
    assert_refused(dig_out_commit(&out, &error), error, DIG_EIO, "folder: ");
    assert_false(scratch_exists("folder.part"));
    assert_int_equal(rmdir(scratch_path("folder")), 0);
}

// The program's output is written where it points to, after what stands there, and stays what it
// is.
TEST(standard_output_is_written_to_and_not_replaced)
{
    struct stat before, after;
    assert_int_equal(lstat("/dev/stdout", &before), 0);
    const int kept = dup(STDOUT_FILENO);
    const int file = open(scratch_path("stdout.txt"), O_WRONLY | O_CREAT, 0666);
    assert_true(kept >= 0 && file >= 0);
    (void)fflush(stdout);
    assert_int_equal(dup2(file, STDOUT_FILENO), STDOUT_FILENO);
    static const char *const names[] = { "/dev/stdout", "-" };
    enum dig_status          status  = DIG_OK;
    for (size_t i = 0; i < 2 && status == DIG_OK; i++) {
        struct dig_out out;
        status = dig_out_open(&out, names[i], NULL);
        if (status == DIG_OK) {
            (void)fprintf(out.file, "line %zu\n", i);
            status = dig_out_commit(&out, NULL);
        }
    }
    (void)dup2(kept, STDOUT_FILENO);
    (void)close(kept);
    (void)close(file);
    assert_int_equal(status, DIG_OK);
    size_t      size = 0;
    char *const text = scratch_read(scratch_path("stdout.txt"), &size);
    assert_string_equal(text, "line 0\nline 1\n");
    free(text);
    assert_int_equal(lstat("/dev/stdout", &after), 0);
    assert_int_equal(before.st_mode, after.st_mode);
    assert_true(before.st_ino == after.st_ino);
}

// From a folder of somebody else's it could point to any file of the user's.
TEST(a_link_is_replaced_and_what_it_points_to_stays)
{
    struct dig_out out;
    struct stat    link;
    assert_int_equal(symlink(scratch_write("target.txt", "old"), scratch_path("link.txt")), 0);
    assert_int_equal(symlink(scratch_path("nowhere.txt"), scratch_path("lost.txt")), 0);
    assert_int_equal(symlink("/dev/null", scratch_path("null.txt")), 0);
    static const char *const names[] = { "link.txt", "lost.txt", "null.txt" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_int_equal(dig_out_open(&out, scratch_path(names[i]), NULL), DIG_OK);
        (void)fputs("new", out.file);
        assert_int_equal(dig_out_commit(&out, NULL), DIG_OK);
        assert_int_equal(lstat(scratch_path(names[i]), &link), 0);
        assert_true(S_ISREG(link.st_mode));
        assert_int_equal(link.st_size, 3);
    }
    size_t      size = 0;
    char *const text = scratch_read(scratch_path("target.txt"), &size);
    assert_string_equal(text, "old");
    free(text);
    assert_false(scratch_exists("nowhere.txt"));

    assert_int_equal(symlink(scratch_dir, scratch_path("folder")), 0);
    assert_int_equal(dig_out_open(&out, scratch_path("folder"), NULL), DIG_EIO);
    assert_int_equal(lstat(scratch_path("folder"), &link), 0);
    assert_true(S_ISLNK(link.st_mode));
}

TESTS_WITH(scratch_setup, scratch_teardown)
