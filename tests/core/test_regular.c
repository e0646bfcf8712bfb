// Tests for core/regular.c

#include "core/regular.h"

#include "tests/scratch.h"
#include "tests/testlib.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

enum { AT_ONCE_s = 5 }; // who waits for a pipe is ended

static void refuse(const char *const path, const enum dig_status status, const char *const says)
{
    struct dig_error error = { "" };
    FILE            *file  = stdin;
    (void)alarm(AT_ONCE_s);
    assert_int_equal(dig_regular_open(path, &file, &error), status);
    (void)alarm(0);
    assert_ptr_equal(file, stdin);
    assert_contains(error.text, path);
    assert_contains(error.text, says);
}

TEST_WITH(a_regular_file_is_opened_by_its_name_or_by_a_link, scratch_setup, scratch_teardown)
{
    assert_int_equal(symlink(scratch_write("file", "abc"), scratch_path("link")), 0);
    static const char *const name[] = { "file", "link" };
    for (size_t i = 0; i < 2; i++) {
        FILE *file = NULL;
        char  read[8];
        assert_int_equal(dig_regular_open(scratch_path(name[i]), &file, NULL), DIG_OK);
        assert_int_equal(fread(read, 1, sizeof read, file), 3);
        assert_int_equal(fclose(file), 0);
    }
}

TEST_WITH(what_is_no_regular_file_is_refused_at_once, scratch_setup, scratch_teardown)
{
    static const char says[] = "no regular file, expected one";
    assert_int_equal(mkfifo(scratch_path("pipe"), 0600), 0);
    refuse(scratch_path("pipe"), DIG_EINVAL, says);
    assert_int_equal(symlink(scratch_path("pipe"), scratch_path("link")), 0);
    refuse(scratch_path("link"), DIG_EINVAL, says);
    assert_int_equal(mkdir(scratch_path("folder"), 0700), 0);
    refuse(scratch_path("folder"), DIG_EINVAL, says);
    assert_int_equal(rmdir(scratch_path("folder")), 0);
    refuse("/dev/zero", DIG_EINVAL, says);
}

TEST_WITH(what_cannot_be_opened_says_why, scratch_setup, scratch_teardown)
{
    refuse(scratch_path("nothing"), DIG_EIO, "No such file");
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    (void)snprintf(address.sun_path, sizeof address.sun_path, "%s", scratch_path("socket"));
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    assert_int_equal(bind(fd, (const struct sockaddr *)&address, sizeof address), 0);
    refuse(scratch_path("socket"), DIG_EIO, "No such device");
    (void)close(fd);
}

TEST_WITH(a_file_is_written_over_where_its_name_or_a_link_leads_to_it, scratch_setup,
          scratch_teardown)
{
    char to[256];
    char by[256];
    char link[256];
    (void)snprintf(to, sizeof to, "%s", scratch_write("file", "abc"));
    (void)snprintf(by, sizeof by, "%s", scratch_path("./file"));
    (void)snprintf(link, sizeof link, "%s", scratch_path("link"));
    assert_int_equal(symlink(to, link), 0);
    assert_true(dig_regular_same(to, by));
    assert_true(dig_regular_same(to, link));
    assert_false(dig_regular_same(link, to)); // it is the link that is replaced
    assert_false(dig_regular_same(to, scratch_path("none")));
    assert_true(dig_regular_same("none", "none"));
    assert_false(dig_regular_same("none", "other"));
    assert_false(dig_regular_same("/dev/null", "/dev/null"));
}
