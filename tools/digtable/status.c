// digtable status.

#include "core/markup.h"
#include "tools/digtable/commands.h"
#include "tools/digtable/job_state.h"
#include "tools/digtable/progress.h"

#include <math.h>
#include <stdio.h>

struct status {
    struct dig_job_folder   folder;
    struct dig_job_state    state;
    struct dig_job_progress progress;
};

// What it said last; a task that is killed says nothing.
static void words_of(const struct status *const s, const size_t task, char words[const 300])
{
    dig_job_last_words(&s->folder, task, 300, words);
    if (words[0] == '\0') {
        (void)snprintf(words, 300, "ended without a word");
    }
}

static void put_text(const struct status *const s)
{
    char                                 words[300];
    char                                 span[32];
    const struct dig_job_progress *const p = &s->progress;
    (void)printf("%zu shards, %zu of %zu digs\n", s->folder.plan.tasks, p->digs_done, p->digs);
    for (enum dig_shard_state state = DIG_SHARD_WAITING; state < DIG_SHARD_STATES; state++) {
        if (s->state.count[state] > 0) {
            (void)printf("%8zu %s\n", s->state.count[state], dig_shard_state_name(state));
        }
    }
    for (size_t task = 1; task <= s->folder.plan.tasks; task++) {
        if (s->state.shard[task] == DIG_SHARD_FAILED) {
            words_of(s, task, words);
            (void)printf("shard %zu failed: %s\n", task, words);
        }
    }
    const enum dig_shard_state merge = s->state.shard[DIG_JOB_MERGE];
    (void)printf("merge %s", dig_shard_state_name(merge));
    if (merge == DIG_SHARD_FAILED) {
        words_of(s, DIG_JOB_MERGE, words);
        (void)printf(": %s", words);
    }
    (void)printf("\n");
    if (isfinite(p->dig_s) && merge != DIG_SHARD_DONE) {
        (void)printf("%.3g s a dig, %s left\n", p->dig_s,
                     dig_progress_span(p->left_s, sizeof span, span));
    }
}

static void put_json(const struct status *const s)
{
    char        words[300];
    const char *gap = "";
    dig_json_put(stdout, "{\"table\": %s,\n \"job\": %s,\n \"shards\": %zu,\n", s->folder.table,
                 s->folder.plan.job, s->folder.plan.tasks);
    for (enum dig_shard_state state = DIG_SHARD_WAITING; state < DIG_SHARD_STATES; state++) {
        dig_json_put(stdout, " %s: %zu,\n", dig_shard_state_name(state), s->state.count[state]);
    }
    dig_json_put(stdout,
                 " \"merge\": %s,\n \"digs\": %zu,\n \"digs_done\": %zu,\n \"dig_s\": %g,\n"
                 " \"left_s\": %g,\n \"failures\": [",
                 dig_shard_state_name(s->state.shard[DIG_JOB_MERGE]), s->progress.digs,
                 s->progress.digs_done, s->progress.dig_s, s->progress.left_s);
    for (size_t task = 0; task <= s->folder.plan.tasks; task++) {
        if (s->state.shard[task] == DIG_SHARD_FAILED) {
            words_of(s, task, words);
            (void)printf("%s\n  {\"shard\": ", gap);
            (void)printf(task == DIG_JOB_MERGE ? "\"merge\"" : "%zu", task);
            dig_json_put(stdout, ", \"error\": %s}", words);
            gap = ",";
        }
    }
    (void)printf("]}\n");
}

int dig_cli_status(const struct dig_arguments *const a)
{
    struct dig_error error  = { "" };
    struct status    s      = { .progress = { .digs = 0 } };
    enum dig_status  status = dig_job_folder_open(a->positional[0], &s.folder, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    status = dig_job_state_read(&s.folder, &s.state, &error);
    if (status != DIG_OK) {
        return dig_cli_work_failed(status, &error);
    }
    dig_job_progress_read(&s.folder, &s.state, &s.progress);
    if (a->json) {
        put_json(&s);
    } else {
        put_text(&s);
    }
    dig_job_state_finish(&s.state);
    return EXIT_DONE;
}
