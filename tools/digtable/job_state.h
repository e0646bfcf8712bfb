// State of the shards of a job folder: by their files, by who holds them, by the queue.

#ifndef DIG_TOOLS_DIGTABLE_JOB_STATE_H
#define DIG_TOOLS_DIGTABLE_JOB_STATE_H

#include "tools/digtable/job_folder.h"

enum dig_shard_state {
    DIG_SHARD_WAITING, // in no queue, and never begun
    DIG_SHARD_PENDING, // in the queue
    DIG_SHARD_RUNNING, // by the queue, or somebody writes to its table
    DIG_SHARD_DONE,    // its table is complete
    DIG_SHARD_FAILED,  // begun, not done, and nobody is at it
    DIG_SHARD_STATES
};

/// "waiting" …, for people and programs.
const char *dig_shard_state_name(enum dig_shard_state state);

struct dig_job_state {
    enum dig_shard_state *shard;                   // [1 … tasks], and at DIG_JOB_MERGE the merge
    size_t                count[DIG_SHARD_STATES]; // of shards
};

/// Asks the queue where something was submitted to it, then looks at the files: so a shard that is
/// done meanwhile is seen. DIG_EIO where the queue does not answer. dig_job_state_finish() it.
DIG_MUST_CHECK enum dig_status dig_job_state_read(const struct dig_job_folder *folder,
                                                  struct dig_job_state        *state,
                                                  struct dig_error            *error);

void dig_job_state_finish(struct dig_job_state *state);

/// The last line of what a shard, or the merge, said; "" where it said nothing.
void dig_job_last_words(const struct dig_job_folder *folder, size_t task, size_t size, char text[]);

/// What is computed, by the tables themselves.
struct dig_job_progress {
    size_t digs, digs_done;
    double dig_s;  // seconds a dig took, the mean of those measured; NaN: none yet
    double left_s; // NaN: not known, or nothing is running
};

/// Opens the tables that grow, and some of those that are complete for their times.
void dig_job_progress_read(const struct dig_job_folder *folder, const struct dig_job_state *state,
                           struct dig_job_progress *progress);

#endif // DIG_TOOLS_DIGTABLE_JOB_STATE_H
