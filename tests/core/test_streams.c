// Tests for core/streams.c, each in a process of its own: standard streams are a process's.

#include "core/streams.h"
#include "tests/scratch.h"

#include <fcntl.h>
#include <sys/wait.h>

// What a program does whose streams are as `arrange` leaves them; its exit status. What it says on
// standard error is in the file "said".
static int status_of(int (*const program)(void))
{
    (void)scratch_write("said", "");
    const pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        (void)fflush(NULL);
        _exit(program());
    }
    int status = 0;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int open_with_all_closed(void)
{
    (void)close(STDIN_FILENO);
    (void)close(STDOUT_FILENO);
    (void)close(STDERR_FILENO);
    dig_streams_begin();
    const int table = open(scratch_path("table"), O_RDWR | O_CREAT, 0666);
    char      byte;
    return table > STDERR_FILENO && fprintf(stderr, "a word\n") < 0 &&
                   read(STDIN_FILENO, &byte, 1) < 0 && write(STDOUT_FILENO, "", 1) < 0
               ? 0
               : 1;
}

TEST(no_file_takes_the_place_of_a_stream_that_is_closed)
{
    assert_int_equal(status_of(open_with_all_closed), 0);
    size_t      size  = 1;
    char *const table = scratch_read(scratch_path("table"), &size);
    assert_int_equal(size, 0);
    free(table);
}

// The streams' numbers are whoever's who has the file already.
static int begin_with_all_open(void)
{
    if (freopen(scratch_path("said"), "w", stderr) == NULL) {
        return 1;
    }
    dig_streams_begin();
    return fputs("heard", stderr) < 0 || fflush(stderr) != 0;
}

TEST(streams_that_are_open_stay_as_they_are)
{
    assert_int_equal(status_of(begin_with_all_open), 0);
    size_t      size = 0;
    char *const said = scratch_read(scratch_path("said"), &size);
    assert_string_equal(said, "heard");
    free(said);
}

// Words, as many as fit the buffer or not, to this file; ends with this code.
static int    code_before;
static size_t words;
static char   to[512];

static int print(void)
{
    if (freopen(scratch_path("said"), "w", stderr) == NULL || freopen(to, "w", stdout) == NULL) {
        return 99;
    }
    for (size_t i = 0; i < words; i++) {
        (void)printf("word %zu\n", i);
    }
    const int code = dig_streams_end("digprobe", code_before);
    return fflush(stderr) == 0 ? code : 99;
}

static void assert_ends(const char *const file, const size_t n, const int code, const int wanted,
                        const char *const said)
{
    (void)snprintf(to, sizeof to, "%s", file);
    words       = n;
    code_before = code;
    assert_int_equal(status_of(print), wanted);
    size_t      size = 0;
    char *const text = scratch_read(scratch_path("said"), &size);
    assert_string_equal(text, said);
    free(text);
}

TEST(an_output_that_is_written_leaves_the_code)
{
    char whole[512];
    (void)snprintf(whole, sizeof whole, "%s", scratch_path("whole"));
    assert_ends(whole, 10000, 0, 0, "");
    assert_ends(whole, 1, 2, 2, "");
    size_t      size = 0;
    char *const text = scratch_read(whole, &size);
    assert_string_equal(text, "word 0\n");
    free(text);
}

TEST(an_output_that_is_cut_is_told_and_ends_in_1)
{
    static const char full[] = "digprobe: standard output: No space left on device\n";
    assert_ends("/dev/full", 0, 0, 0, "");
    assert_ends("/dev/full", 1, 0, 1, full);
    assert_ends("/dev/full", 10000, 0, 1, full);
    assert_ends("/dev/full", 1, 2, 2, full);
}

TESTS_WITH(scratch_setup, scratch_teardown)
