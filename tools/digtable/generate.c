// digtable generate.

#include "core/text.h"
#include "tables/store.h"
#include "tools/digtable/commands.h"
#include "tools/digtable/plan.h"
#include "tools/digtable/progress.h"

#include <stdio.h>
#include <stdlib.h>

static void report_sweep(void *const context, const struct dig_sweep_state *const s)
{
    struct dig_progress_line *const line = context;
    if (dig_progress_is_due(line)) {
        char elapsed[32];
        char left[32];
        (void)fprintf(stderr, "%s%zu of %zu digs, %zu running, %s elapsed, %s left",
                      dig_progress_start(line), s->digs_done, s->digs_total, s->workers,
                      dig_progress_span(s->elapsed_s, sizeof elapsed, elapsed),
                      dig_progress_span(s->left_s, sizeof left, left));
        dig_progress_end(line, false);
    }
}

static int report_end(const struct dig_arguments *const a, const struct dig_sweep_state *const s,
                      const enum dig_status status, const struct dig_error *const error)
{
    if (a->quiet && status == DIG_OK && s->digs_done == s->digs_total) {
        return EXIT_DONE;
    }
    char elapsed[32];
    dig_text_print(stderr, "%s: %zu of %zu digs, %s", a->output, s->digs_done, s->digs_total,
                   dig_progress_span(s->elapsed_s, sizeof elapsed, elapsed));
    if (s->digs_done < s->digs_total) {
        (void)fprintf(stderr, "; %zu left%s, the same command goes on with them",
                      s->digs_total - s->digs_done,
                      status != DIG_OK ? ""
                      : *a->stop != 0  ? " (interrupted)"
                                       : " (time limit)");
    }
    (void)fputc('\n', stderr);
    if (status != DIG_OK) {
        if (s->failed > 0) {
            (void)fprintf(stderr, "digtable: %zu digs failed, the first:\n", s->failed);
        }
        return dig_cli_work_failed(status, error);
    }
    return *a->stop != 0 && s->digs_done < s->digs_total ? EXIT_WORK_FAILED : EXIT_DONE;
}

static int sweep(const struct dig_arguments *const a, const struct dig_scene *const scene,
                 const struct dig_plan *const plan)
{
    struct dig_error        error  = { "" };
    struct dig_store       *store  = NULL;
    const struct dig_engine engine = dig_cli_engine(a);
    enum dig_status         status = dig_plan_check(plan, scene, &error);
    if (status == DIG_OK) {
        status = dig_store_create(a->output, scene, &store, &error);
    }
    if (status != DIG_OK) {
        return dig_cli_work_failed(status, &error);
    }
    struct dig_progress_line       line    = dig_progress_line(a->quiet);
    const struct dig_sweep_options options = {
        .workers      = a->workers,
        .time_limit_s = a->time_limit_s,
        .stop         = a->stop,
        .report       = report_sweep,
        .context      = &line,
    };
    struct dig_sweep_state state = { .digs_total = 0 };
    status = dig_sweep_run(scene, plan, &engine, &options, store, &state, &error);
    dig_store_close(store);
    if (state.failed > 0) {
        status = dig_error_name(&error, status, "%s", a->positional[0]);
    }
    if (line.tty) {
        dig_progress_end(&line, true);
    }
    return report_end(a, &state, status, &error);
}

int dig_cli_generate(const struct dig_arguments *const a)
{
    if (a->output == NULL) {
        return dig_cli_bad_usage(a, "generate: %s missing", "-o TABLE.sqlite");
    }
    struct dig_error       error = { "" };
    struct dig_scene       scene;
    struct dig_plan        plan   = { .points = 0 };
    struct dig_plan_point *point  = NULL;
    const enum dig_status  status = dig_plan_read(a->positional[0], a->positional[1], a->packings,
                                                  &scene, &plan, &point, &error);
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    plan.shard     = a->shard;
    plan.shards    = a->shards;
    const int code = sweep(a, &scene, &plan);
    free(point);
    return code;
}
