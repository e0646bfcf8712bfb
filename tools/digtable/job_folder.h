// The folder of a table that is computed in shards (docs/formats/tables.md, "Job folder"):
//
//   TABLE.jobs/ plan.yaml scene.yaml grid.yaml   what is computed, in how many shards
//               run.sh                           computes one, or merges all
//               part/7.sqlite                    shard 7 as it grows
//               shards/7.sqlite                  shard 7, complete
//               log/7.log log/merge.log          what their last attempts said
//               slurm                            the jobs submitted: there may be some in a queue
//               lock                             held by who submits

#ifndef DIG_TOOLS_DIGTABLE_JOB_FOLDER_H
#define DIG_TOOLS_DIGTABLE_JOB_FOLDER_H

#include "core/error.h"
#include "files/job_plan.h"

#include <limits.h>
#include <signal.h>
#include <stddef.h>

#define DIG_JOB_MERGE 0 // in place of a shard's number

struct dig_job_folder {
    char                table[PATH_MAX]; // absolute, as is path
    char                path[PATH_MAX];  // table and ".jobs"
    int                 lock_fd;         // -1: not locked
    struct dig_job_plan plan;
};

/// Makes the folder of a table where there is none, without a plan, and locks it. Waits where
/// another process has the lock, and says so, until *stop. DIG_EINVAL: a name that is refused, or
/// something else in the way. Close it.
DIG_MUST_CHECK enum dig_status dig_job_folder_make(const char                  *table,
                                                   const volatile sig_atomic_t *stop,
                                                   struct dig_job_folder       *folder,
                                                   struct dig_error            *error);

/// Makes the folders in it that are not there.
DIG_MUST_CHECK enum dig_status dig_job_folder_make_rooms(const struct dig_job_folder *folder,
                                                         struct dig_error            *error);

/// The folder of a table, to look at.
DIG_MUST_CHECK enum dig_status dig_job_folder_open(const char *table, struct dig_job_folder *folder,
                                                   struct dig_error *error);

/// Lets go of the lock; harmless without.
void dig_job_folder_close(struct dig_job_folder *folder);

/// The path of a file in the folder. Returns path.
const char *dig_job_folder_file(const struct dig_job_folder *folder, const char *name,
                                char path[PATH_MAX]);

/// The path of a shard's file: "part", 7, "sqlite"; with DIG_JOB_MERGE that of the merge.
const char *dig_job_folder_of(const struct dig_job_folder *folder, const char *kind, size_t task,
                              const char *end, char path[PATH_MAX]);

#endif // DIG_TOOLS_DIGTABLE_JOB_FOLDER_H
