// digtable submit: what of a table's shards is neither done nor at work is given to Slurm. Exactly
// once: whoever submits holds the folder's lock from looking to having submitted.

#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/commands.h"
#include "tools/digtable/job_planning.h"
#include "tools/digtable/job_state.h"
#include "tools/digtable/plan.h"
#include "tools/digtable/slurm.h"

#include <stdio.h>
#include <stdlib.h>

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

static enum dig_status submit(const struct dig_arguments *const  a,
                              const struct dig_job_wanted *const wanted, struct submission *const s,
                              struct dig_error *const error)
{
    char            id[64] = "";
    enum dig_status status = dig_slurm_check(error);
    if (status == DIG_OK) {
        status = dig_job_plan_folder(a->output, wanted, a->stop, &s->folder, error);
    }
    if (status == DIG_OK) {
        status = dig_job_script_write(&s->folder, wanted->packings, error);
    }
    if (status == DIG_OK) {
        status = choose(s, error);
    }
    if (status == DIG_OK && (s->submits > 0 || lacks_merge(s))) {
        status = dig_slurm_submit(a, &s->folder, s->submit, id, error);
    }
    if (status == DIG_OK) {
        report(a, s, id);
    }
    return status;
}

int dig_cli_submit(const struct dig_arguments *const a)
{
    if (a->output == NULL) {
        return dig_cli_bad_usage(a, "submit: %s missing", "-o TABLE.sqlite");
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
