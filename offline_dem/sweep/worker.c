#include "offline_dem/sweep/worker.h"

#include "offline_dem/dig/variant.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define REPORT_EVERY_s 0.5
#define ROWS_MAX       1000000 // of one curve; more means a corrupt message

double dig_sweep_now_s(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// State of the child: its job, and its progress in simulated seconds.
struct child {
    const struct dig_scene  *scene;
    const struct dig_engine *engine;
    const struct dig_job    *job;
    double                   deadline_s;
    int                      fd;
    double                   total_s;    // simulated, estimate for the whole job
    double                   before_s;   // of finished parts
    double                   current_s;  // of the running part
    double                   reported_s; // wall clock
};

static void send_all(const int fd, const void *const data, const size_t size)
{
    const char *at   = data;
    size_t      left = size;
    while (left > 0) {
        const ssize_t wrote = write(fd, at, left);
        if (wrote < 0 && errno != EINTR) {
            _exit(1); // nobody reads any more
        }
        at += wrote > 0 ? wrote : 0;
        left -= wrote > 0 ? (size_t)wrote : 0;
    }
}

static int send_progress(void *const context, const double done_s, const double total_s)
{
    struct child *const child = context;
    const double        now_s = dig_sweep_now_s();
    if (now_s - child->reported_s >= REPORT_EVERY_s && total_s > 0.0) {
        child->reported_s                = now_s;
        const struct dig_message message = {
            .kind = DIG_MESSAGE_PROGRESS,
            .fraction =
                (child->before_s + child->current_s * fmin(done_s / total_s, 1.0)) / child->total_s,
        };
        send_all(child->fd, &message, sizeof message);
    }
    return 1;
}

static void send_failure(const struct child *const child, const enum dig_status status,
                         const struct dig_error *const error)
{
    struct dig_message message = { .kind = DIG_MESSAGE_FAILURE };
    (void)snprintf(message.text, sizeof message.text, "%s",
                   error->text[0] != '\0' ? error->text : dig_status_str(status));
    send_all(child->fd, &message, sizeof message);
}

static double pouring_s(const struct dig_scene *const scene)
{
    return scene->packing.settle_s + scene->packing.relax_s;
}

static double job_s(const struct dig_scene *const scene, const struct dig_job *const job)
{
    double sum_s = pouring_s(scene);
    for (size_t i = 0; i < job->digs; i++) {
        sum_s += dig_trajectory_duration_s(&scene->trajectory[job->trajectory[i]]);
    }
    return sum_s;
}

// All digs of the job in one bed. False when one failed; the failure was sent.
static bool dig_all(struct child *const child, const struct dig_progress *const progress,
                    const struct dig_bed *const bed, const double poured_from_s)
{
    double from_s = poured_from_s;
    for (size_t i = 0; i < child->job->digs; i++) {
        // The bed was poured for the first dig; the limit stops the next ones.
        if (i > 0 && dig_sweep_now_s() >= child->deadline_s) {
            return true;
        }
        const size_t          at = child->job->trajectory[i];
        struct dig_trajectory t;
        struct dig_recording  recording = { 0 };
        struct dig_error      error     = { "" };
        enum dig_status status = dig_approach_make(child->scene, &child->scene->trajectory[at],
                                                   &child->job->origin.approach, &t, &error);
        if (status == DIG_OK) {
            child->current_s = dig_trajectory_duration_s(&t);
            status           = child->engine->dig(&child->engine->stepper, child->scene,
                                                  &child->job->origin.gravel, bed, &t, NULL, progress,
                                                  &recording, &error);
        }
        if (status != DIG_OK) {
            send_failure(child, status, &error);
            return false;
        }
        child->before_s += child->current_s;

        const double             now_s   = dig_sweep_now_s();
        const struct dig_message message = {
            .kind       = DIG_MESSAGE_CURVE,
            .trajectory = at,
            .rows       = recording.rows,
            .grains     = bed->grains,
            .wall_s     = now_s - from_s,
        };
        from_s = now_s;
        send_all(child->fd, &message, sizeof message);
        send_all(child->fd, recording.row, recording.rows * sizeof *recording.row);
        dig_recording_finish(&recording);
    }
    return true;
}

// The scene of the job's bed: the plain one, or *varied, with the job's effect in it.
static enum dig_status apply_effect(struct child *const child, struct dig_scene *const varied,
                                    struct dig_error *const error)
{
    const struct dig_run_origin *const o = &child->job->origin;
    if (o->effect[0] == '\0') {
        return DIG_OK;
    }
    const enum dig_effect_id effect = (enum dig_effect_id)dig_effect_find(o->effect);
    const enum dig_status    status =
        dig_variant_make(child->scene, effect, o->magnitude, varied, error);
    if (status == DIG_OK) {
        child->scene = varied;
    }
    return status;
}

static void work(struct child *const child)
{
    const struct dig_progress progress = { send_progress, child };
    const double              from_s   = dig_sweep_now_s();
    struct dig_scene          varied;
    struct dig_bed            bed    = { 0 };
    struct dig_error          error  = { "" };
    enum dig_status           status = apply_effect(child, &varied, &error);
    child->total_s                   = job_s(child->scene, child->job);
    child->current_s                 = pouring_s(child->scene);
    if (status == DIG_OK) {
        status =
            child->engine->pour(&child->engine->stepper, child->scene, &child->job->origin.gravel,
                                child->job->origin.seed, &progress, &bed, &error);
    }
    if (status != DIG_OK) {
        send_failure(child, status, &error);
        return;
    }
    child->before_s += child->current_s;
    if (dig_all(child, &progress, &bed, from_s)) {
        const struct dig_message end = { .kind = DIG_MESSAGE_END };
        send_all(child->fd, &end, sizeof end);
    }
    dig_bed_finish(&bed);
}

// Runs in the child and never returns. _exit leaves the parent's buffers and handlers alone.
_Noreturn static void become_worker(struct child *const child, const pid_t parent)
{
    // Ctrl-C reaches the whole group; the parent decides what it means.
    const struct sigaction ignore = { .sa_handler = SIG_IGN };
    const struct sigaction normal = { .sa_handler = SIG_DFL };
    (void)sigaction(SIGINT, &ignore, NULL);
    (void)sigaction(SIGTERM, &normal, NULL);
    (void)sigaction(SIGPIPE, &normal, NULL);

    // Nobody would read the results of an orphan.
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) {
        _exit(1);
    }
    work(child);
    _exit(0);
}

enum dig_status dig_worker_start(struct dig_worker *const       worker,
                                 const struct dig_scene *const  scene,
                                 const struct dig_engine *const engine,
                                 const struct dig_job *const job, const double deadline_s,
                                 struct dig_store *const store, const size_t others,
                                 const struct dig_worker other[], struct dig_error *const error)
{
    assert(worker != NULL && worker->pid == 0);
    int end[2];
    if (pipe(end) != 0) {
        return dig_error_set(error, DIG_EIO, "pipe: %s", strerror(errno));
    }
    struct child child = {
        .scene      = scene,
        .engine     = engine,
        .job        = job,
        .deadline_s = deadline_s,
        .fd         = end[1],
    };
    const pid_t parent = getpid();
    const pid_t pid    = fork();
    if (pid == 0) {
        (void)close(end[0]);
        for (size_t i = 0; i < others; i++) {
            if (other[i].pid != 0) {
                (void)close(other[i].fd);
            }
        }
        dig_store_forget(store);
        become_worker(&child, parent);
    }
    const int why = errno;
    (void)close(end[1]);
    if (pid < 0) {
        (void)close(end[0]);
        return dig_error_set(error, DIG_EIO, "fork: %s", strerror(why));
    }
    (void)fcntl(end[0], F_SETFL, O_NONBLOCK);
    *worker = (struct dig_worker){ .pid = pid, .fd = end[0], .job = *job, .digs = job->digs };
    return DIG_OK;
}

bool dig_worker_read(struct dig_worker *const worker)
{
    for (;;) {
        if (worker->room - worker->used < 65536) {
            const size_t room = worker->room * 2 + 131072;
            char *const  more = realloc(worker->bytes, room);
            if (more == NULL) {
                return false; // the dig is lost, and tried again
            }
            worker->bytes = more;
            worker->room  = room;
        }
        const ssize_t got =
            read(worker->fd, worker->bytes + worker->used, worker->room - worker->used);
        if (got > 0) {
            worker->used += (size_t)got;
        } else if (got == 0) {
            return false;
        } else if (errno != EINTR) {
            return errno == EAGAIN || errno == EWOULDBLOCK;
        }
    }
}

bool dig_worker_next(struct dig_worker *const worker, struct dig_message *const message,
                     struct dig_force_row **const rows)
{
    struct dig_message head;
    *rows = NULL;
    if (worker->used < sizeof head) {
        return false;
    }
    memcpy(&head, worker->bytes, sizeof head);
    const size_t size =
        head.kind == DIG_MESSAGE_CURVE && head.rows <= ROWS_MAX ? head.rows * sizeof **rows : 0;
    const size_t whole = sizeof head + size;
    if (worker->used < whole) {
        return false;
    }
    if (size > 0) {
        *rows = malloc(size);
        if (*rows == NULL) {
            return false;
        }
        memcpy(*rows, worker->bytes + sizeof head, size);
    }
    worker->used -= whole;
    memmove(worker->bytes, worker->bytes + whole, worker->used);
    *message = head;
    return true;
}

int dig_worker_finish(struct dig_worker *const worker)
{
    int status = 0;
    (void)close(worker->fd);
    while (waitpid(worker->pid, &status, 0) < 0 && errno == EINTR) {
    }
    free(worker->bytes);
    *worker = (struct dig_worker){ .pid = 0 };
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}
