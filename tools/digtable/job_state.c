#include "tools/digtable/job_state.h"

#include "core/process.h"
#include "core/regular.h"
#include "tables/store.h"
#include "tools/digtable/slurm.h"

#include <assert.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#define COMPLETE_MAX 20 // tables of complete shards that are opened to learn how long a dig takes

const char *dig_shard_state_name(const enum dig_shard_state state)
{
    static const char *const names[DIG_SHARD_STATES] = { "waiting", "pending", "running", "done",
                                                         "failed" };
    assert(state < DIG_SHARD_STATES);
    return names[state];
}

// Whoever adds to a table holds its lock (tables/store.h).
static bool is_held(const char *const path)
{
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        return false;
    }
    const bool held = flock(fd, LOCK_SH | LOCK_NB) != 0;
    (void)close(fd);
    return held;
}

// Where the queue says `queued` of it; DIG_SHARD_WAITING: nothing.
static enum dig_shard_state state_of(const struct dig_job_folder *const folder, const size_t task,
                                     const enum dig_shard_state queued)
{
    char path[PATH_MAX];
    if (access(folder->table, F_OK) == 0) {
        return DIG_SHARD_DONE;
    }
    if (task != DIG_JOB_MERGE) {
        if (access(dig_job_folder_of(folder, "shards", task, "sqlite", path), F_OK) == 0) {
            return DIG_SHARD_DONE;
        }
        if (is_held(dig_job_folder_of(folder, "part", task, "sqlite", path))) {
            return DIG_SHARD_RUNNING;
        }
    }
    if (queued != DIG_SHARD_WAITING) {
        return queued;
    }
    return access(dig_job_folder_of(folder, "log", task, "log", path), F_OK) == 0
               ? DIG_SHARD_FAILED
               : DIG_SHARD_WAITING;
}

enum dig_status dig_job_state_read(const struct dig_job_folder *const folder,
                                   struct dig_job_state *const state, struct dig_error *const error)
{
    char                        path[PATH_MAX];
    const size_t                tasks                   = folder->plan.tasks;
    size_t                      count[DIG_SHARD_STATES] = { 0 };
    enum dig_status             status                  = DIG_OK;
    enum dig_shard_state *const shard                   = calloc(tasks + 1, sizeof *shard);
    if (shard == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory for %zu tasks", tasks);
    }
    if (access(dig_job_folder_file(folder, "slurm", path), F_OK) == 0) {
        status = dig_slurm_queue(&folder->plan, shard, error);
    }
    if (status != DIG_OK) {
        free(shard);
        return status;
    }
    for (size_t task = 0; task <= tasks; task++) {
        shard[task] = state_of(folder, task, shard[task]);
        count[shard[task]] += task != DIG_JOB_MERGE ? 1 : 0;
    }
    state->shard = shard;
    memcpy(state->count, count, sizeof count);
    return DIG_OK;
}

void dig_job_state_finish(struct dig_job_state *const state)
{
    free(state->shard);
    *state = (struct dig_job_state){ .shard = NULL };
}

void dig_job_last_words(const struct dig_job_folder *const folder, const size_t task,
                        const size_t size, char text[const])
{
    char  path[PATH_MAX];
    FILE *file = NULL;
    text[0]    = '\0';
    (void)dig_job_folder_of(folder, "log", task, "log", path);
    if (dig_regular_open(path, &file, NULL) == DIG_OK) {
        dig_process_last_line(file, size, text);
        (void)fclose(file);
    }
}

struct tally {
    size_t digs;
    double wall_s;
};

static enum dig_status count(void *const context, const struct dig_run *const run,
                             struct dig_error *const error)
{
    struct tally *const t = context;
    (void)error;
    t->digs++;
    t->wall_s += run->origin.wall_s;
    return DIG_OK;
}

// Adds what a table holds; one that is not begun, or that a task has just moved, holds nothing.
static size_t add_table(const char *const path, struct tally *const tally)
{
    struct tally                 one     = { .digs = 0 };
    const struct dig_run_visitor visitor = { count, &one };
    struct dig_store            *store   = NULL;
    if (access(path, F_OK) != 0 || dig_store_open(path, &store, NULL) != DIG_OK) {
        return 0;
    }
    const enum dig_status status = dig_store_walk(store, &visitor, NULL);
    dig_store_close(store);
    if (status != DIG_OK) {
        return 0;
    }
    tally->digs += one.digs;
    tally->wall_s += one.wall_s;
    return one.digs;
}

void dig_job_progress_read(const struct dig_job_folder *const folder,
                           const struct dig_job_state *const  state,
                           struct dig_job_progress *const     progress)
{
    char                    path[PATH_MAX];
    struct dig_job_progress p        = { .digs = 0 };
    struct tally            measured = { .digs = 0 };
    size_t                  running  = 0;
    size_t                  most     = 0; // digs that one task has left
    size_t                  opened   = 0;
    for (size_t task = 1; task <= folder->plan.tasks; task++) {
        const size_t digs = dig_job_plan_digs(&folder->plan, task);
        size_t       done = digs;
        if (state->shard[task] != DIG_SHARD_DONE) {
            done = add_table(dig_job_folder_of(folder, "part", task, "sqlite", path), &measured);
        } else if (opened < COMPLETE_MAX) {
            opened++;
            (void)add_table(dig_job_folder_of(folder, "shards", task, "sqlite", path), &measured);
        }
        running += state->shard[task] == DIG_SHARD_RUNNING ? 1 : 0;
        most = digs - done > most ? digs - done : most;
        p.digs += digs;
        p.digs_done += done;
    }
    // No sooner than all that is running can do together, nor than one task does what it has left.
    p.dig_s           = measured.digs > 0 ? measured.wall_s / (double)measured.digs : (double)NAN;
    const double left = (double)(p.digs - p.digs_done);
    p.left_s  = running > 0 ? p.dig_s * fmax(left / (double)running, (double)most) : (double)NAN;
    p.left_s  = p.digs_done == p.digs ? 0.0 : p.left_s;
    *progress = p;
}
