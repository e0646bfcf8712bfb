// run.sh of a job folder: what a shell reads, a laptop's as well as Slurm's.

#ifndef DIG_TOOLS_DIGTABLE_JOB_SCRIPT_H
#define DIG_TOOLS_DIGTABLE_JOB_SCRIPT_H

#include "tools/digtable/job_folder.h"

/// Anew for each submit, as programs move; whole or not at all. packings: see dig_job_wanted.
DIG_MUST_CHECK enum dig_status dig_job_script_write(const struct dig_job_folder *folder,
                                                    size_t packings, struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_JOB_SCRIPT_H
