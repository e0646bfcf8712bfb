// Slurm, by its own commands: sbatch submits, squeue tells what is queued. No accounting is asked.
// Jobs are known by their name, the folder's: that holds even where sbatch was cut off before its
// answer was written down.

#ifndef DIG_TOOLS_DIGTABLE_SLURM_H
#define DIG_TOOLS_DIGTABLE_SLURM_H

#include "tools/digtable/arguments.h"
#include "tools/digtable/job_folder.h"
#include "tools/digtable/job_state.h"

#include <stdio.h>

/// DIG_EINVAL where one of the two commands cannot be run.
DIG_MUST_CHECK enum dig_status dig_slurm_check(struct dig_error *error);

/// Sets shards (and at DIG_JOB_MERGE the merge) that are in the queue to DIG_SHARD_PENDING or
/// DIG_SHARD_RUNNING. DIG_EIO where the queue does not answer.
DIG_MUST_CHECK enum dig_status dig_slurm_queue(const struct dig_job_plan *plan,
                                               enum dig_shard_state       shard[],
                                               struct dig_error          *error);

/// Lines of squeue as dig_slurm_queue() asks for them: a task's number or "N/A", and a state.
void dig_slurm_read_queue(FILE *lines, size_t tasks, enum dig_shard_state shard[]);

/// The numbers of the shards to be submitted, "3,7,9-12"; false where they do not fit.
bool dig_slurm_ranges(size_t tasks, const bool submit[], size_t size, char text[]);

/// Submits these shards as one job array and, after all that is queued of the folder, a merge; with
/// none of them, the merge alone. The answer goes into *id. DIG_EINVAL where the folder
/// has a name that Slurm would not leave as it is, and with sbatch's own words where it refuses.
DIG_MUST_CHECK enum dig_status dig_slurm_submit(const struct dig_arguments  *a,
                                                const struct dig_job_folder *folder,
                                                const bool submit[], char id[64],
                                                struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_SLURM_H
