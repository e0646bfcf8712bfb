// A folder of its own for a test program's files: made before the tests, removed after them.
//   TESTS_WITH(scratch_setup, scratch_teardown)

#ifndef DIG_TESTS_SCRATCH_H
#define DIG_TESTS_SCRATCH_H

#include "tests/testlib.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char scratch_dir[256];

static inline int scratch_setup(void **state)
{
    (void)state;
    const char *const temporary = getenv("TMPDIR");
    (void)snprintf(scratch_dir, sizeof scratch_dir, "%s/dig_test_XXXXXX",
                   temporary != NULL ? temporary : "/tmp");
    return mkdtemp(scratch_dir) != NULL ? 0 : -1;
}

/// The path of a file in the folder; valid until the fourth next call.
static inline const char *scratch_path(const char *const name)
{
    static char     path[4][512];
    static unsigned turn;
    turn = (turn + 1) % 4;
    (void)snprintf(path[turn], sizeof path[turn], "%s/%s", scratch_dir, name);
    return path[turn];
}

static inline int scratch_teardown(void **state)
{
    (void)state;
    DIR *const dir = opendir(scratch_dir);
    for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;) {
        (void)unlink(scratch_path(entry->d_name));
    }
    if (dir != NULL) {
        (void)closedir(dir);
    }
    return rmdir(scratch_dir);
}

static inline const char *scratch_write_bytes(const char *const name, const void *const bytes,
                                              const size_t size)
{
    const char *const path = scratch_path(name);
    FILE *const       file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

static inline const char *scratch_write(const char *const name, const char *const text)
{
    return scratch_write_bytes(name, text, strlen(text));
}

/// The whole of a file, malloc'ed, with a NUL behind it.
static inline char *scratch_read(const char *const path, size_t *const size)
{
    FILE *const file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long length = ftell(file);
    assert_true(length >= 0);
    rewind(file);
    char *const text = malloc((size_t)length + 1);
    assert_non_null(text);
    *size       = fread(text, 1, (size_t)length, file);
    text[*size] = '\0';
    (void)fclose(file);
    return text;
}

static inline int scratch_exists(const char *const name)
{
    return access(scratch_path(name), F_OK) == 0;
}

#endif // DIG_TESTS_SCRATCH_H
