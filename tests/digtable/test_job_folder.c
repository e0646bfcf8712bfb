// Tests for tools/digtable/job_folder.c: which folder is meant, and its names. What a submit makes
// of it, and refuses, is in tests/system/digtable_jobs.sh.

#include "tools/digtable/job_folder.h"

#include "tests/scratch.h"

#include <sys/stat.h>

static int fresh(void **state)
{
    char path[300];
    char plan[400];
    if (scratch_setup(state) != 0) {
        return -1;
    }
    (void)snprintf(path, sizeof path, "%s/t.sqlite.jobs", scratch_dir);
    (void)snprintf(plan, sizeof plan, "%s/plan.yaml", path);
    size_t      size = 0;
    char *const text = scratch_read("tests/data/formats/plan.yaml", &size);
    if (mkdir(path, 0777) != 0) {
        return -1;
    }
    FILE *const file = fopen(plan, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    free(text);
    return 0;
}

static int gone(void **state)
{
    char path[300];
    (void)unlink(scratch_path("t.sqlite.jobs/plan.yaml"));
    (void)snprintf(path, sizeof path, "%s/t.sqlite.jobs", scratch_dir);
    (void)rmdir(path);
    return scratch_teardown(state);
}

TEST_WITH(the_folder_stands_beside_its_table, fresh, gone)
{
    struct dig_job_folder folder;
    char                  path[PATH_MAX];
    struct dig_error      error = { "" };
    assert_ok(dig_job_folder_open(scratch_path("t.sqlite"), &folder, &error), error);
    assert_string_equal(folder.table, scratch_path("t.sqlite"));
    assert_string_equal(folder.path, scratch_path("t.sqlite.jobs"));
    assert_int_equal(folder.plan.tasks, 3);
    assert_string_equal(dig_job_folder_of(&folder, "part", 7, "sqlite", path),
                        scratch_path("t.sqlite.jobs/part/7.sqlite"));
    assert_string_equal(dig_job_folder_of(&folder, "log", DIG_JOB_MERGE, "log", path),
                        scratch_path("t.sqlite.jobs/log/merge.log"));
}

TEST_WITH(a_link_in_it_is_refused, fresh, gone)
{
    struct dig_job_folder folder = { .lock_fd = 77 };
    struct dig_error      error  = { "" };
    char                  log[300];
    (void)snprintf(log, sizeof log, "%s/t.sqlite.jobs/log", scratch_dir);
    assert_int_equal(mkdir(log, 0777), 0);
    assert_int_equal(symlink("../../elsewhere", scratch_path("t.sqlite.jobs/log/1.log")), 0);
    assert_int_equal(dig_job_folder_open(scratch_path("t.sqlite"), &folder, &error), DIG_EINVAL);
    assert_contains(error.text, "log/1.log: expected a file of digtable submit's, not a ");
    assert_int_equal(unlink(scratch_path("t.sqlite.jobs/log/1.log")), 0);
    assert_int_equal(rmdir(log), 0);
    assert_int_equal(symlink("..", log), 0);
    assert_int_equal(dig_job_folder_open(scratch_path("t.sqlite"), &folder, &error), DIG_EINVAL);
    assert_contains(error.text, "jobs/log: expected a folder of digtable submit's, not a ");
    assert_int_equal(unlink(log), 0);
}

TEST_WITH(what_names_no_table_is_refused, fresh, gone)
{
    static const char *const names[] = { "", ".", "..", "a/..", "two\nlines", "\033[31m", "none" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct dig_job_folder folder = { .lock_fd = 77 };
        struct dig_error      error  = { "" };
        assert_int_not_equal(dig_job_folder_open(names[i], &folder, &error), DIG_OK);
        assert_int_equal(folder.lock_fd, 77);
        assert_string_not_equal(error.text, "");
    }
}

// Its files' names are longer yet.
TEST_WITH(a_path_without_room_is_refused, fresh, gone)
{
    static char           name[2 * PATH_MAX];
    struct dig_job_folder folder;
    struct dig_error      error = { "" };
    memset(name, 'a', sizeof name - 1);
    name[0] = '/';
    for (size_t length = PATH_MAX - 60; length < sizeof name; length += 37) {
        const char at = name[length];
        name[length]  = '\0';
        assert_int_not_equal(dig_job_folder_open(name, &folder, &error), DIG_OK);
        name[length] = at;
    }
}
