// A bed in a process of its own, and the pipe for its curves. Internal to the sweep.

#ifndef DIG_OFFLINE_DEM_SWEEP_WORKER_H
#define DIG_OFFLINE_DEM_SWEEP_WORKER_H

#include "offline_dem/sweep/sweep.h"

#include <stdbool.h>
#include <sys/types.h>

enum dig_message_kind {
    DIG_MESSAGE_PROGRESS, // progress of the running dig
    DIG_MESSAGE_CURVE,    // a dig is done; its rows follow
    DIG_MESSAGE_FAILURE,  // the bed failed; text says why
    DIG_MESSAGE_END,      // all done, or the time limit
};

/// Fixed part of a worker's message. Parent and worker are the same program, so the bytes in memory
/// are the format.
struct dig_message {
    enum dig_message_kind kind;
    size_t                trajectory; // of a curve: index in the scene
    size_t                rows;       // of a curve
    size_t                grains;     // of a curve
    double                wall_s;     // of a curve: its dig, and the pouring in the first
    double                fraction;   // of progress: share of all simulated seconds
    char                  text[512];  // of a failure
};

struct dig_worker {
    pid_t          pid;  // 0: free
    int            fd;   // read end of its pipe
    struct dig_job job;  // digs left
    size_t         digs; // digs at its start
    size_t         attempts;
    double         fraction; // of all simulated time
    bool           ended;    // it sent its end or a failure
    // Bytes of an incomplete message.
    char  *bytes;
    size_t used, room;
};

/// Forks a worker for the job. The child closes the pipes of the `others`, which run already; else
/// it would keep them open.
DIG_MUST_CHECK enum dig_status
dig_worker_start(struct dig_worker *worker, const struct dig_scene *scene,
                 const struct dig_engine *engine, const struct dig_job *job, double deadline_s,
                 struct dig_store *store, size_t others, const struct dig_worker other[],
                 struct dig_error *error);

/// Reads the available bytes without waiting. False: the pipe is closed, the worker has ended.
bool dig_worker_read(struct dig_worker *worker);

/// Takes the next complete message; rows are malloc'ed. False when there is none.
bool dig_worker_next(struct dig_worker *worker, struct dig_message *message,
                     struct dig_force_row **rows);

/// Waits for the process and frees the worker. Returns the signal that killed it, or 0.
int dig_worker_finish(struct dig_worker *worker);

#endif // DIG_OFFLINE_DEM_SWEEP_WORKER_H
