// Tests for tools/digtable/slurm.c: what is said to sbatch and heard of squeue. A real Slurm is
// asked in tests/system/slurm.sh.

#include "tools/digtable/slurm.h"

#include "tests/testlib.h"

#include <string.h>

enum { TASKS = 12 };

TEST(runs_of_shards_are_named_by_their_ends)
{
    static const struct {
        const char *submit; // shard 1 first
        const char *ranges;
    } cases[] = {
        { "------------", "" },          { "x-----------", "1" },   { "-----------x", "12" },
        { "xxxxxxxxxxxx", "1-12" },      { "xx----------", "1-2" }, { "x-x-xx------", "1,3,5-6" },
        { "-xxx-----xxx", "2-4,10-12" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        bool submit[TASKS + 1] = { false };
        char text[64];
        for (size_t task = 1; task <= TASKS; task++) {
            submit[task] = cases[i].submit[task - 1] == 'x';
        }
        assert_true(dig_slurm_ranges(TASKS, submit, sizeof text, text));
        assert_string_equal(text, cases[i].ranges);
        // One byte less than it needs is refused.
        const size_t length = strlen(text);
        assert_true(dig_slurm_ranges(TASKS, submit, length + 1, text));
        assert_int_equal(dig_slurm_ranges(TASKS, submit, length > 0 ? length : 1, text),
                         length == 0);
    }
}

static void hear(const char *const lines, enum dig_shard_state shard[const TASKS + 1])
{
    FILE *const file = tmpfile();
    assert_non_null(file);
    assert_true(fputs(lines, file) >= 0);
    rewind(file);
    memset(shard, 0, (TASKS + 1) * sizeof *shard);
    dig_slurm_read_queue(file, TASKS, shard);
    (void)fclose(file);
}

TEST(what_squeue_lists_is_pending_or_running)
{
    enum dig_shard_state shard[TASKS + 1];
    hear("1 PD\n2 R\n12 CG\n3 CF\n4 S\nN/A PD\n", shard);
    static const enum dig_shard_state wanted[TASKS + 1] = {
        [DIG_JOB_MERGE] = DIG_SHARD_PENDING,
        [1]             = DIG_SHARD_PENDING,
        [2]             = DIG_SHARD_RUNNING,
        [3]             = DIG_SHARD_RUNNING,
        [4]             = DIG_SHARD_RUNNING,
        [12]            = DIG_SHARD_RUNNING,
    };
    assert_memory_equal(shard, wanted, sizeof wanted);
    hear("N/A R\n", shard);
    assert_int_equal(shard[DIG_JOB_MERGE], DIG_SHARD_RUNNING);
}

TEST(what_is_no_shard_is_passed_over)
{
    enum dig_shard_state shard[TASKS + 1];
    hear("\n0 R\n13 R\n99999999999999999999 R\n-1 R\nR\n7\n7x R\nslurm_load_jobs error\n", shard);
    for (size_t task = 0; task <= TASKS; task++) {
        assert_int_equal(shard[task], DIG_SHARD_WAITING);
    }
}
