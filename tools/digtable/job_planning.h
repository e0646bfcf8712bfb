// The plan of a job folder: made once, and the same in every submit after.

#ifndef DIG_TOOLS_DIGTABLE_JOB_PLANNING_H
#define DIG_TOOLS_DIGTABLE_JOB_PLANNING_H

#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/job_folder.h"

/// What is planned: scene_path and grid_path read, the plan in one part, and its engine.
struct dig_job_wanted {
    const char              *scene_path, *grid_path;
    const struct dig_scene  *scene;
    const struct dig_plan   *plan;
    const struct dig_engine *engine;
    size_t                   packings; // over the grid's; 0: the grid's
    size_t                   tasks;    // 0: as planned, or the default
};

/// Makes and locks the folder of a table, and plans what is wanted; where that was done before,
/// checks that it was the same. DIG_EINVAL, beside dig_job_folder_make's: a plan that differs, more
/// tasks than beds, a table in the way.
DIG_MUST_CHECK enum dig_status dig_job_plan_folder(const char                  *table,
                                                   const struct dig_job_wanted *wanted,
                                                   const volatile sig_atomic_t *stop,
                                                   struct dig_job_folder       *folder,
                                                   struct dig_error            *error);

/// Writes run.sh, which a shell reads, a laptop's as well as Slurm's: anew for each submit, as
/// programs move; whole or not at all. packings: see dig_job_wanted.
DIG_MUST_CHECK enum dig_status dig_job_script_write(const struct dig_job_folder *folder,
                                                    size_t packings, struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_JOB_PLANNING_H
