// The plan of a table that is computed in shards, one job a shard: `plan.yaml` of a job folder
// (docs/formats/tables.md, "Job folder"). Written once; who comes later compares.

#ifndef DIG_FILES_JOB_PLAN_H
#define DIG_FILES_JOB_PLAN_H

#include "core/error.h"

#include <stddef.h>

#define DIG_JOB_TEXT_SIZE 40
#define DIG_JOB_TASKS_MAX 10000

struct dig_job_plan {
    char   job[DIG_JOB_TEXT_SIZE]; // the name by which a queue knows its jobs, of no other folder
    char   digs_sha256[65];        // of all that the runs follow from
    char   engine[DIG_JOB_TEXT_SIZE];
    char   version[DIG_JOB_TEXT_SIZE];
    size_t tasks;        // shards, 1 to DIG_JOB_TASKS_MAX
    size_t beds;         // of the whole plan, at least as many; shard I has every tasks-th
    size_t trajectories; // digs a bed
};

/// DIG_EINVAL names file, line and key; DIG_EIO when it cannot be read. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_job_plan_read(const char *path, struct dig_job_plan *plan,
                                                 struct dig_error *error);

/// Writes the file whole or not at all.
DIG_MUST_CHECK enum dig_status dig_job_plan_write(const char *path, const struct dig_job_plan *plan,
                                                  struct dig_error *error);

/// The digs of shard `task`, from 1.
size_t dig_job_plan_digs(const struct dig_job_plan *plan, size_t task);

#endif // DIG_FILES_JOB_PLAN_H
