// One bed in a process of its own, and the pipe its curves come back through. Internal to the
// sweep.

#ifndef DIG_OFFLINE_DEM_SWEEP_WORKER_H
#define DIG_OFFLINE_DEM_SWEEP_WORKER_H

#include "offline_dem/sweep/sweep.h"

#include <stdbool.h>
#include <sys/types.h>

enum dig_message_kind {
    DIG_MESSAGE_PROGRESS, // how far the dig under way is
    DIG_MESSAGE_CURVE,    // a dig is done; its rows follow
    DIG_MESSAGE_FAILURE,  // the bed is given up; why stands in text
    DIG_MESSAGE_END,      // nothing more comes: all done, or the time limit
};

/// The fixed part of what a worker writes: parent and worker are the same program, so the bytes in
/// memory are the format.
struct dig_message {
    enum dig_message_kind kind;
    size_t                trajectory; // of a curve: index in the scene
    size_t                rows;       // of a curve
    size_t                grains;     // of a curve
    double                wall_s;     // of a curve: its dig, and the pouring in the first
    double                fraction;   // of progress: of all seconds the worker has to simulate
    char                  text[512];  // of a failure
};

struct dig_worker {
    pid_t          pid;  // 0: free
    int            fd;   // read end of its pipe
    struct dig_job job;  // what it has still to dig
    size_t         digs; // what it had to dig when it began
    size_t         attempts;
    double         fraction; // of all it has to simulate
    bool           ended;    // it said so, or said why not
    // Bytes read and not yet a whole message.
    char  *bytes;
    size_t used, room;
};

/// Forks a worker for the job. `others` are the pipes of the workers that run already: the child
/// closes them, else a worker would keep its siblings' pipes open.
DIG_MUST_CHECK enum dig_status
dig_worker_start(struct dig_worker *worker, const struct dig_scene *scene,
                 const struct dig_engine *engine, const struct dig_job *job, double deadline_s,
                 struct dig_store *store, size_t others, const struct dig_worker other[],
                 struct dig_error *error);

/// Reads what is there without waiting. false: the pipe is closed, the worker is over.
bool dig_worker_read(struct dig_worker *worker);

/// Takes the next whole message off; rows are malloc'ed. false when there is none.
bool dig_worker_next(struct dig_worker *worker, struct dig_message *message,
                     struct dig_force_row **rows);

/// Waits for the process and frees what the worker holds. Returns the signal that killed it, or 0.
int dig_worker_finish(struct dig_worker *worker);

/// Seconds on the monotonic clock.
double dig_sweep_now_s(void);

#endif // DIG_OFFLINE_DEM_SWEEP_WORKER_H
