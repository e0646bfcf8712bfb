#include "offline_dem/sweep/sweep.h"

#include "core/text.h"
#include "offline_dem/dig/checked_pour.h"
#include "offline_dem/sweep/worker.h"

#include <assert.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define ATTEMPTS_MAX   2 // of a bed whose worker was killed
#define WAIT_ms        250
#define REPORT_EVERY_s 1.0

struct dig_engine dig_engine_kernel(void)
{
    return (struct dig_engine){
        .name    = "kernel",
        .version = DIG_VERSION "+" DIG_NUMERICS,
        .pour    = dig_bed_pour_checked,
        .dig     = dig_dig_run,
    };
}

struct dig_engine dig_engine_single(void)
{
    struct dig_engine engine = dig_engine_kernel();
    engine.name              = "single";
    engine.stepper           = (struct dig_stepper){ .single_precision = true };
    return engine;
}

struct sweep {
    const struct dig_scene         *scene;
    const struct dig_engine        *engine;
    const struct dig_sweep_options *options;
    struct dig_store               *store;
    struct dig_sweep_state         *state;
    struct dig_error               *error;
    enum dig_status                 status; // of the first failure
    struct dig_queue                queue;
    size_t                          next; // job to be started next
    struct dig_worker              *worker;
    struct pollfd                  *poll;
    double                          from_s, reported_s;
    size_t                          done_before; // at the start of the sweep
    bool                            stopping;
};

// Reports the first failure; the sweep goes on with the other beds.
static void record_failure(struct sweep *const s, const struct dig_job *const job,
                           const size_t digs, const char *const why)
{
    s->state->failed += digs;
    if (s->status == DIG_OK) {
        const struct dig_run_origin *const o          = &job->origin;
        char                               effect[64] = "";
        char                               how[DIG_APPROACH_TEXT_SIZE];
        dig_approach_text(&o->approach, how);
        if (o->effect[0] != '\0') {
            (void)snprintf(effect, sizeof effect, ", %s %g", o->effect, o->magnitude);
        }
        s->status = dig_error_set(s->error, DIG_EIO,
                                  "friction %g, rolling %g, %g kg/m3%s%s, packing %zu: %.400s",
                                  o->gravel.value[0], o->gravel.value[1], o->gravel.value[2],
                                  effect, how, o->packing, why);
    }
}

static void update(struct sweep *const s)
{
    struct dig_sweep_state *const st = s->state;
    st->digs_under_way               = 0.0;
    st->workers                      = 0;
    for (size_t i = 0; i < s->options->workers; i++) {
        const struct dig_worker *const w = &s->worker[i];
        if (w->pid != 0) {
            st->workers++;
            // The worker's fraction includes digs that are stored and counted.
            const double begun = w->fraction * (double)w->digs;
            st->digs_under_way += fmax(begun - (double)(w->digs - w->job.digs), 0.0);
        }
    }
    st->elapsed_s      = dig_sweep_now_s() - s->from_s;
    const double mine  = (double)(st->digs_done - s->done_before) + st->digs_under_way;
    const double total = (double)(st->digs_total - st->failed - s->done_before);
    st->left_s         = mine > 0.0 ? st->elapsed_s * fmax(total - mine, 0.0) / mine : (double)NAN;
}

static void report_progress(struct sweep *const s, const bool now)
{
    const double at_s = dig_sweep_now_s();
    if (s->options->report != NULL && (now || at_s - s->reported_s >= REPORT_EVERY_s)) {
        s->reported_s = at_s;
        update(s);
        s->options->report(s->options->context, s->state);
    }
}

// Removes a stored dig: a second attempt computes what is left.
static void remove_dig(struct dig_job *const job, const size_t trajectory)
{
    size_t kept = 0;
    for (size_t i = 0; i < job->digs; i++) {
        if (job->trajectory[i] != trajectory) {
            job->trajectory[kept++] = job->trajectory[i];
        }
    }
    job->digs = kept;
}

static enum dig_status store_curve(struct sweep *const s, struct dig_worker *const w,
                                   const struct dig_message *const m,
                                   struct dig_force_row *const rows, struct dig_error *const error)
{
    struct dig_run_origin origin = w->job.origin;
    origin.trajectory            = m->trajectory;
    origin.grains                = m->grains;
    origin.wall_s                = m->wall_s;
    (void)snprintf(origin.engine, sizeof origin.engine, "%s", s->engine->name);
    (void)snprintf(origin.version, sizeof origin.version, "%s", s->engine->version);
    dig_text_utc(time(NULL), sizeof origin.made_utc, origin.made_utc);
    const struct dig_recording recording = { .rows = m->rows, .row = rows };
    return dig_store_put(s->store, &origin, &recording, error);
}

// One message of a worker. A table that cannot be written ends the sweep.
static void take_message(struct sweep *const s, struct dig_worker *const w,
                         const struct dig_message *const m, struct dig_force_row *const rows)
{
    switch (m->kind) {
    case DIG_MESSAGE_PROGRESS: w->fraction = m->fraction; break;
    case DIG_MESSAGE_CURVE: {
        struct dig_error      error  = { "" };
        const enum dig_status status = store_curve(s, w, m, rows, &error);
        if (status == DIG_EINVAL) {
            record_failure(s, &w->job, 1, error.text); // the table refuses the curve
            break;
        }
        if (status != DIG_OK) {
            s->status   = dig_error_set(s->error, status, "%s", error.text);
            s->stopping = true;
            break;
        }
        remove_dig(&w->job, m->trajectory);
        s->state->digs_done++;
        report_progress(s, true);
        break;
    }
    case DIG_MESSAGE_FAILURE:
        w->ended = true;
        record_failure(s, &w->job, w->job.digs, m->text);
        break;
    case DIG_MESSAGE_END: w->ended = true; break;
    }
}

static void take_messages(struct sweep *const s, struct dig_worker *const w)
{
    struct dig_message    message;
    struct dig_force_row *rows = NULL;
    while (dig_worker_next(w, &message, &rows)) {
        take_message(s, w, &message, rows);
        free(rows);
    }
}

static double deadline_s(const struct sweep *const s)
{
    return s->from_s + s->options->time_limit_s;
}

static bool may_start(const struct sweep *const s)
{
    return !s->stopping && dig_sweep_now_s() < deadline_s(s);
}

static void start(struct sweep *const s, struct dig_worker *const w,
                  const struct dig_job *const job, const size_t attempts)
{
    const enum dig_status status =
        dig_worker_start(w, s->scene, s->engine, job, deadline_s(s), s->store, s->options->workers,
                         s->worker, s->error);
    if (status != DIG_OK) {
        s->status   = status;
        s->stopping = true;
        return;
    }
    w->attempts = attempts;
}

// The pipe is closed: the worker is done, gave up, or was killed.
static void reap(struct sweep *const s, struct dig_worker *const w)
{
    const struct dig_job job      = w->job;
    const size_t         attempts = w->attempts;
    const bool           ended    = w->ended;
    const int            signal   = dig_worker_finish(w);
    if (ended || job.digs == 0 || s->stopping) {
        return;
    }
    if (attempts < ATTEMPTS_MAX && may_start(s)) {
        start(s, w, &job, attempts + 1);
    } else if (attempts >= ATTEMPTS_MAX) {
        char why[80];
        (void)snprintf(why, sizeof why, "the worker was killed by signal %d, twice", signal);
        record_failure(s, &job, job.digs, why);
    }
}

static void start_workers(struct sweep *const s)
{
    for (size_t i = 0; i < s->options->workers; i++) {
        if (s->worker[i].pid == 0 && s->next < s->queue.jobs && may_start(s)) {
            start(s, &s->worker[i], &s->queue.job[s->next++], 1);
        }
    }
}

static void stop_workers(struct sweep *const s)
{
    for (size_t i = 0; i < s->options->workers; i++) {
        if (s->worker[i].pid != 0) {
            (void)kill(s->worker[i].pid, SIGTERM);
        }
    }
}

// Waits for messages of any worker; false when none is running.
static bool poll_workers(struct sweep *const s)
{
    nfds_t running = 0;
    for (size_t i = 0; i < s->options->workers; i++) {
        if (s->worker[i].pid != 0) {
            s->poll[running++] = (struct pollfd){ .fd = s->worker[i].fd, .events = POLLIN };
        }
    }
    if (running == 0) {
        return false;
    }
    (void)poll(s->poll, running, WAIT_ms);
    for (size_t i = 0; i < s->options->workers; i++) {
        struct dig_worker *const w = &s->worker[i];
        if (w->pid != 0) {
            const bool open = dig_worker_read(w);
            take_messages(s, w);
            if (!open) {
                reap(s, w);
            }
        }
    }
    return true;
}

static void run(struct sweep *const s)
{
    bool has_stopped_workers = false;
    do {
        s->stopping = s->stopping || (s->options->stop != NULL && *s->options->stop != 0);
        if (s->stopping && !has_stopped_workers) {
            stop_workers(s);
            has_stopped_workers = true;
        }
        start_workers(s);
        report_progress(s, false);
    } while (poll_workers(s));
}

enum dig_status dig_sweep_run(const struct dig_scene *const         scene,
                              const struct dig_plan *const          plan,
                              const struct dig_engine *const        engine,
                              const struct dig_sweep_options *const options,
                              struct dig_store *const store, struct dig_sweep_state *const state,
                              struct dig_error *const error)
{
    assert(scene != NULL && plan != NULL && engine != NULL && options != NULL && state != NULL);
    assert(options->workers >= 1);

    *state         = (struct dig_sweep_state){ .left_s = (double)NAN };
    struct sweep s = {
        .scene   = scene,
        .engine  = engine,
        .options = options,
        .store   = store,
        .state   = state,
        .error   = error,
        .from_s  = dig_sweep_now_s(),
    };
    const enum dig_status status = dig_queue_make(store, plan, &s.queue, error);
    if (status != DIG_OK) {
        return status;
    }
    s.worker = calloc(options->workers, sizeof *s.worker);
    s.poll   = calloc(options->workers, sizeof *s.poll);
    if (s.worker == NULL || s.poll == NULL) {
        s.status = dig_error_set(error, DIG_ENOMEM, "no memory for %zu workers", options->workers);
    } else {
        state->digs_total = s.queue.digs_total;
        state->digs_done  = s.queue.digs_done;
        s.done_before     = s.queue.digs_done;
        run(&s);
        update(&s);
    }
    free(s.worker);
    free(s.poll);
    dig_queue_finish(&s.queue);
    return s.status;
}
