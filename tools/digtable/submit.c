// digtable submit: what of a table's shards is neither done nor at work is computed, here or by
// Slurm. Exactly once: whoever submits holds the folder's lock from looking to having submitted.

#include "core/process.h"
#include "core/text.h"
#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/commands.h"
#include "tools/digtable/job_planning.h"
#include "tools/digtable/job_state.h"
#include "tools/digtable/plan.h"
#include "tools/digtable/progress.h"
#include "tools/digtable/slurm.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct submission {
    struct dig_job_folder folder;
    struct dig_job_state  state;
    bool                 *submit; // [tasks + 1]: these shards
    size_t                submits;
};

// What failed or was never begun; none of it where the table is there.
static enum dig_status choose(struct submission *const s, struct dig_error *const error)
{
    const size_t          tasks  = s->folder.plan.tasks;
    const enum dig_status status = dig_job_state_read(&s->folder, &s->state, error);
    if (status != DIG_OK) {
        return status;
    }
    s->submit = calloc(tasks + 1, sizeof *s->submit);
    if (s->submit == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory for %zu tasks", tasks);
    }
    for (size_t task = 1; task <= tasks; task++) {
        const enum dig_shard_state now = s->state.shard[task];
        s->submit[task]                = now == DIG_SHARD_FAILED || now == DIG_SHARD_WAITING;
        s->submits += s->submit[task] ? 1 : 0;
    }
    return DIG_OK;
}

static bool lacks_merge(const struct submission *const s)
{
    const enum dig_shard_state merge = s->state.shard[DIG_JOB_MERGE];
    return merge == DIG_SHARD_FAILED || merge == DIG_SHARD_WAITING;
}

static void report(const struct dig_arguments *const a, const struct submission *const s,
                   const char *const id)
{
    if (a->quiet) {
        return;
    }
    const size_t *const count = s->state.count;
    (void)fprintf(stderr, "digtable: %zu shards: %zu done, %zu running, %zu pending",
                  s->folder.plan.tasks, count[DIG_SHARD_DONE], count[DIG_SHARD_RUNNING],
                  count[DIG_SHARD_PENDING]);
    if (id[0] != '\0' && s->submits > 0) {
        (void)fprintf(stderr, "; %zu submitted as job %s", s->submits, id);
    } else if (id[0] != '\0') {
        (void)fprintf(stderr, "; the merge submitted as job %s", id);
    } else {
        (void)fprintf(stderr, "; nothing to submit");
    }
    (void)fputc('\n', stderr);
}

static enum dig_status to_slurm(const struct dig_arguments *const a,
                                const struct submission *const s, struct dig_error *const error)
{
    char            id[64] = "";
    enum dig_status status = DIG_OK;
    if (s->submits > 0 || lacks_merge(s)) {
        status = dig_slurm_submit(a, &s->folder, s->submit, id, error);
    }
    if (status == DIG_OK) {
        report(a, s, id);
    }
    return status;
}

struct watched {
    const struct dig_job_folder *folder;
    struct dig_progress_line     line;
    double                       from_s;
    bool                         printed;
};

static void report_progress(void *const context)
{
    struct watched *const w     = context;
    struct dig_job_state  state = { .shard = NULL };
    if (!dig_progress_is_due(&w->line) || dig_job_state_read(w->folder, &state, NULL) != DIG_OK) {
        return;
    }
    char                    elapsed[32];
    char                    left[32];
    struct dig_job_progress p;
    dig_job_progress_read(w->folder, &state, &p);
    (void)fprintf(stderr, "%s%zu of %zu digs, %zu shards running, %s elapsed, %s left",
                  dig_progress_start(&w->line), p.digs_done, p.digs, state.count[DIG_SHARD_RUNNING],
                  dig_progress_span(dig_sweep_now_s() - w->from_s, sizeof elapsed, elapsed),
                  dig_progress_span(p.left_s, sizeof left, left));
    dig_progress_end(&w->line, false);
    dig_job_state_finish(&state);
    w->printed = true;
}

// The shards by their numbers to xargs, which runs a->workers scripts at a time.
static enum dig_status compute(const struct dig_arguments *const a, struct submission *const s,
                               FILE *const numbers, struct dig_error *const error)
{
    char workers[24];
    char script[PATH_MAX];
    (void)snprintf(workers, sizeof workers, "%" PRIu64, a->workers);
    (void)dig_job_folder_file(&s->folder, "run.sh", script);
    struct watched watched = { .folder = &s->folder,
                               .line   = dig_progress_line(a->quiet),
                               .from_s = dig_sweep_now_s() };
    // Each time all tables that grow are opened.
    watched.line.every_s             = fmax(watched.line.every_s, 5.0);
    const char *const        argv[]  = { "xargs", "-P", workers, "-n", "1", "sh", script, NULL };
    const struct dig_process process = {
        .argv    = argv,
        .without = "SLURM_", // within a job of Slurm's, too, this is none
        .in      = numbers,
        .out     = stderr,
        .stop    = a->stop,
        .watch   = report_progress,
        .context = &watched,
    };
    for (size_t task = 1; task <= s->folder.plan.tasks; task++) {
        if (s->submit[task]) {
            (void)fprintf(numbers, "%zu\n", task);
        }
    }
    if (fflush(numbers) != 0) {
        return dig_error_set(error, DIG_EIO, "a temporary file: %s", strerror(errno));
    }
    rewind(numbers);
    const enum dig_status status = dig_process_run(&process, error);
    if (watched.printed && watched.line.tty) {
        dig_progress_end(&watched.line, true);
    }
    return status;
}

static enum dig_status merge(const struct submission *const s, struct dig_error *const error)
{
    char              words[300];
    char              script[PATH_MAX];
    const char *const argv[] = { "sh", dig_job_folder_file(&s->folder, "run.sh", script), "merge",
                                 NULL };
    const struct dig_process process = { .argv = argv, .without = "SLURM_", .out = stderr };
    if (dig_process_run(&process, NULL) == DIG_OK) {
        return DIG_OK;
    }
    dig_job_last_words(&s->folder, DIG_JOB_MERGE, sizeof words, words);
    return dig_error_set(error, DIG_EINVAL, "the merge failed: %s", words);
}

// Why not all shards are done: one that failed, one that runs elsewhere, one not begun.
static enum dig_status unfinished(const struct dig_arguments *const a,
                                  const struct submission *const s, struct dig_error *const error)
{
    const size_t *const count = s->state.count;
    char                words[300];
    if (*a->stop != 0) {
        return dig_error_set(error, DIG_EIO, "interrupted, the same command goes on");
    }
    for (size_t task = 1; task <= s->folder.plan.tasks; task++) {
        if (s->state.shard[task] == DIG_SHARD_FAILED) {
            dig_job_last_words(&s->folder, task, sizeof words, words);
            return dig_error_set(error, DIG_EIO, "%zu of %zu shards failed, the first, %zu: %s",
                                 count[DIG_SHARD_FAILED], s->folder.plan.tasks, task, words);
        }
    }
    return dig_error_set(error, DIG_EIO,
                         "%zu shards are left, %zu of them computed elsewhere; try again later",
                         s->folder.plan.tasks - count[DIG_SHARD_DONE],
                         count[DIG_SHARD_RUNNING] + count[DIG_SHARD_PENDING]);
}

static enum dig_status here(const struct dig_arguments *const a, struct submission *const s,
                            struct dig_error *const error)
{
    FILE *const numbers = tmpfile();
    if (numbers == NULL) {
        return dig_error_set(error, DIG_EIO, "a temporary file: %s", strerror(errno));
    }
    if (s->submits > 0 && !a->quiet) {
        (void)fprintf(stderr, "digtable: %zu of %zu shards to compute, %" PRIu64 " at a time\n",
                      s->submits, s->folder.plan.tasks, a->workers);
    }
    // By their files it is told which failed.
    enum dig_status status = s->submits > 0 ? compute(a, s, numbers, error) : DIG_OK;
    (void)fclose(numbers);
    if (status == DIG_EINVAL) {
        return status;
    }
    dig_job_state_finish(&s->state);
    status = dig_job_state_read(&s->folder, &s->state, error);
    if (status == DIG_OK && s->state.count[DIG_SHARD_DONE] < s->folder.plan.tasks) {
        status = unfinished(a, s, error);
    } else if (status == DIG_OK && lacks_merge(s)) {
        status = merge(s, error);
    }
    if (status == DIG_OK && !a->quiet) {
        dig_text_print(stderr, "%s: %zu of %zu shards\n", a->output, s->folder.plan.tasks,
                       s->folder.plan.tasks);
    }
    return status;
}

static enum dig_status submit(const struct dig_arguments *const  a,
                              const struct dig_job_wanted *const wanted, struct submission *const s,
                              struct dig_error *const error)
{
    enum dig_status status = a->slurm ? dig_slurm_check(error) : DIG_OK;
    if (status == DIG_OK) {
        status = dig_job_plan_folder(a->output, wanted, a->stop, &s->folder, error);
    }
    if (status == DIG_OK) {
        status = dig_job_script_write(&s->folder, wanted->packings, error);
    }
    if (status == DIG_OK) {
        status = choose(s, error);
    }
    if (status == DIG_OK) {
        status = a->slurm ? to_slurm(a, s, error) : here(a, s, error);
    }
    return status;
}

int dig_cli_submit(const struct dig_arguments *const a)
{
    if (a->output == NULL) {
        return dig_cli_bad_usage(a, "submit: %s missing", "-o TABLE.sqlite");
    }
    if (!a->slurm && (a->time != NULL || a->partition != NULL || a->sbatch_args > 0)) {
        return dig_cli_bad_usage(a, "submit: %s is for --slurm",
                                 a->time != NULL        ? "--time"
                                 : a->partition != NULL ? "--partition"
                                                        : a->sbatch_arg[0]);
    }
    struct dig_error        error = { "" };
    struct dig_scene        scene;
    struct dig_plan         plan   = { .points = 0 };
    struct dig_plan_point  *point  = NULL;
    struct submission       s      = { .folder = { .lock_fd = -1 } };
    const struct dig_engine engine = dig_cli_engine(a);
    enum dig_status status = dig_plan_read(a->positional[0], a->positional[1], a->packings, &scene,
                                           &plan, &point, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    const struct dig_job_wanted wanted = {
        .scene_path = a->positional[0],
        .grid_path  = a->positional[1],
        .scene      = &scene,
        .plan       = &plan,
        .engine     = &engine,
        .packings   = a->packings,
        .tasks      = a->tasks,
    };
    status = dig_plan_check(&plan, &scene, &error);
    if (status == DIG_OK) {
        status = submit(a, &wanted, &s, &error);
    }
    dig_job_state_finish(&s.state);
    dig_job_folder_close(&s.folder);
    free(s.submit);
    free(point);
    return status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
}
