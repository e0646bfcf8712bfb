// Tests for tools/digtable/job_state.c: states by files and locks. The queue's part is in
// test_slurm.c.

#include "tools/digtable/job_state.h"

#include "tests/tables_fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <sys/file.h>
#include <sys/stat.h>

enum { TASKS = 5 };

static const char *const     rooms[] = { ".", "part", "shards", "log" };
static struct dig_job_folder folder;

// Five shards of 2, 2, 1, 1 and 1 beds, two digs each.
static int fresh(void **state)
{
    (void)state;
    char path[PATH_MAX];
    if (scratch_setup(state) != 0) {
        return -1;
    }
    folder = (struct dig_job_folder){
        .lock_fd = -1,
        .plan    = { .job = "digtable-test", .tasks = TASKS, .beds = 7, .trajectories = 2 },
    };
    (void)snprintf(folder.table, sizeof folder.table, "%s/t.sqlite", scratch_dir);
    (void)snprintf(folder.path, sizeof folder.path, "%s/t.jobs", scratch_dir);
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        (void)dig_job_folder_file(&folder, rooms[i], path);
        assert_int_equal(mkdir(i > 0 ? path : folder.path, 0777), 0);
    }
    return 0;
}

static int gone(void **state)
{
    char path[PATH_MAX];
    for (size_t i = sizeof rooms / sizeof rooms[0]; i-- > 0;) {
        DIR *const dir = opendir(dig_job_folder_file(&folder, rooms[i], path));
        assert_non_null(dir);
        for (const struct dirent *entry; (entry = readdir(dir)) != NULL;) {
            (void)unlinkat(dirfd(dir), entry->d_name, 0);
        }
        (void)closedir(dir);
        assert_int_equal(rmdir(i > 0 ? path : folder.path), 0);
    }
    return scratch_teardown(state);
}

static void touch(const char *const kind, const size_t task, const char *const end,
                  const char *const text)
{
    char        path[PATH_MAX];
    FILE *const file = fopen(dig_job_folder_of(&folder, kind, task, end, path), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void put_table(const char *const kind, const size_t task, const size_t runs,
                      const double wall_s)
{
    char                   path[PATH_MAX];
    const struct dig_scene scene = fixture_scene();
    struct dig_store      *store = NULL;
    assert_int_equal(dig_store_create(dig_job_folder_of(&folder, kind, task, "sqlite", path),
                                      &scene, &store, NULL),
                     DIG_OK);
    for (size_t i = 0; i < runs; i++) {
        struct dig_run_origin origin = fixture_origin(.5, .5, 2500.0, i, 0);
        origin.wall_s                = wall_s;
        fixture_put_run(store, origin, 1.0);
    }
    dig_store_close(store);
}

static struct dig_job_state look(void)
{
    struct dig_job_state state;
    struct dig_error     error = { "" };
    assert_ok(dig_job_state_read(&folder, &state, &error), error);
    return state;
}

TEST_WITH(a_shard_is_what_its_files_and_locks_say, fresh, gone)
{
    char path[PATH_MAX];
    touch("shards", 1, "sqlite", "");
    touch("log", 1, "log", "all went well\n");
    touch("log", 2, "log", "why\n");
    touch("part", 3, "sqlite", "");
    touch("log", 3, "log", "");
    touch("part", 4, "sqlite", "");
    touch("log", 4, "log", "");
    const int fd = open(dig_job_folder_of(&folder, "part", 4, "sqlite", path), O_RDWR);
    assert_true(fd >= 0);
    assert_int_equal(flock(fd, LOCK_EX), 0);
    struct dig_job_state state = look();
    assert_int_equal(state.shard[1], DIG_SHARD_DONE);
    assert_int_equal(state.shard[2], DIG_SHARD_FAILED);
    assert_int_equal(state.shard[3], DIG_SHARD_FAILED); // nobody is at it
    assert_int_equal(state.shard[4], DIG_SHARD_RUNNING);
    assert_int_equal(state.shard[5], DIG_SHARD_WAITING);
    assert_int_equal(state.shard[DIG_JOB_MERGE], DIG_SHARD_WAITING);
    assert_int_equal(state.count[DIG_SHARD_FAILED], 2);
    assert_int_equal(state.count[DIG_SHARD_DONE], 1);
    dig_job_state_finish(&state);
    (void)close(fd);
}

TEST_WITH(with_the_table_all_is_done, fresh, gone)
{
    touch("log", 2, "log", "why\n");
    touch("log", DIG_JOB_MERGE, "log", "why\n");
    struct dig_job_state state = look();
    assert_int_equal(state.shard[DIG_JOB_MERGE], DIG_SHARD_FAILED);
    dig_job_state_finish(&state);
    (void)scratch_write("t.sqlite", "");
    state = look();
    assert_int_equal(state.count[DIG_SHARD_DONE], TASKS);
    assert_int_equal(state.shard[DIG_JOB_MERGE], DIG_SHARD_DONE);
    dig_job_state_finish(&state);
}

TEST_WITH(the_last_words_are_the_logs_last_line, fresh, gone)
{
    char words[40] = "as it was";
    dig_job_last_words(&folder, 2, sizeof words, words);
    assert_string_equal(words, "");
    touch("log", 2, "log", "first\nwhy\n\n");
    dig_job_last_words(&folder, 2, sizeof words, words);
    assert_string_equal(words, "why");
}

// 14 digs: 4 of a complete shard, 3 of one that grows, at 10 and 30 s each; two tasks run, and one
// of them has all of its four digs before it.
TEST_WITH(time_left_is_that_of_the_digs_left, fresh, gone)
{
    struct dig_job_progress p;
    enum dig_shard_state    shard[TASKS + 1] = {
           [1] = DIG_SHARD_DONE,
           [2] = DIG_SHARD_RUNNING,
           [3] = DIG_SHARD_RUNNING,
    };
    const struct dig_job_state state = { .shard = shard };
    dig_job_progress_read(&folder, &state, &p);
    assert_int_equal(p.digs, 14);
    assert_int_equal(p.digs_done, 4);
    assert_true(isnan(p.dig_s) && isnan(p.left_s));

    put_table("shards", 1, 4, 10.0);
    put_table("part", 2, 3, 30.0);
    dig_job_progress_read(&folder, &state, &p);
    assert_int_equal(p.digs_done, 7);
    assert_close(p.dig_s, (4 * 10.0 + 3 * 30.0) / 7, 1e-9);
    assert_close(p.left_s, p.dig_s * 7 / 2, 1e-9); // two at a time

    shard[4] = shard[5] = DIG_SHARD_DONE;
    dig_job_progress_read(&folder, &state, &p);
    assert_close(p.left_s, p.dig_s * 2, 1e-9); // the third shard has two, one after the other

    shard[2] = shard[3] = DIG_SHARD_PENDING;
    dig_job_progress_read(&folder, &state, &p);
    assert_true(isnan(p.left_s)); // nothing runs

    shard[2] = shard[3] = DIG_SHARD_DONE;
    dig_job_progress_read(&folder, &state, &p);
    assert_int_equal(p.digs_done, 14);
    assert_close(p.left_s, 0.0, 0.0);
}
