#include "tools/digtable/job_planning.h"

#include "core/sha256.h"
#include "files/text/whole.h"
#include "tools/digtable/plan.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static enum dig_status copy(const char *const from, const char *const to,
                            struct dig_error *const error)
{
    char           *text   = NULL;
    size_t          size   = 0;
    struct dig_out  out    = { .file = NULL };
    enum dig_status status = dig_file_read(from, &text, &size, error);
    if (status == DIG_OK) {
        status = dig_out_open(&out, to, error);
    }
    if (status == DIG_OK) {
        (void)fwrite(text, 1, size, out.file);
        status = dig_out_commit(&out, error);
    }
    free(text);
    return status;
}

// A name that no other folder's jobs have, in any queue, wherever this one is moved.
static void name_job(const struct dig_job_folder *const folder, char job[const DIG_JOB_TEXT_SIZE])
{
    char            text[PATH_MAX + 100];
    char            hex[65];
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    const int length =
        snprintf(text, sizeof text, "%s %s %lld.%09ld %ld", folder->path, folder->plan.digs_sha256,
                 (long long)now.tv_sec, now.tv_nsec, (long)getpid());
    dig_sha256_hex(text, (size_t)length, hex);
    (void)snprintf(job, DIG_JOB_TEXT_SIZE, "digtable-%.12s", hex);
}

// plan.yaml comes last: without it the folder is not planned, and the next submit begins anew.
static enum dig_status fill(const struct dig_job_wanted *const wanted,
                            struct dig_job_folder *const folder, struct dig_error *const error)
{
    char path[PATH_MAX];
    if (access(folder->table, F_OK) == 0) {
        return dig_error_set(error, DIG_EINVAL, "%s: exists, expected a new table", folder->table);
    }
    name_job(folder, folder->plan.job);
    enum dig_status status = dig_job_folder_make_rooms(folder, error);
    if (status == DIG_OK) {
        status = copy(wanted->scene_path, dig_job_folder_file(folder, "scene.yaml", path), error);
    }
    if (status == DIG_OK) {
        status = copy(wanted->grid_path, dig_job_folder_file(folder, "grid.yaml", path), error);
    }
    return status == DIG_OK ? dig_job_plan_write(dig_job_folder_file(folder, "plan.yaml", path),
                                                 &folder->plan, error)
                            : status;
}

// The plan that is there against the one wanted.
static enum dig_status compare(const struct dig_job_wanted *const wanted,
                               const struct dig_job_plan *const   as_wanted,
                               struct dig_job_folder *const folder, struct dig_error *const error)
{
    char                             path[PATH_MAX];
    char                             tasks[2][24];
    const struct dig_job_plan *const there = &folder->plan;
    const enum dig_status            status =
        dig_job_plan_read(dig_job_folder_file(folder, "plan.yaml", path), &folder->plan, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)snprintf(tasks[0], sizeof tasks[0], "%zu", there->tasks);
    (void)snprintf(tasks[1], sizeof tasks[1], "%zu",
                   wanted->tasks != 0 ? wanted->tasks : there->tasks);
    const char *const same[][3] = {
        { "the engine", there->engine, as_wanted->engine },
        { "version", there->version, as_wanted->version },
        { "another scene or grid, digs", there->digs_sha256, as_wanted->digs_sha256 },
        { "--tasks", tasks[0], tasks[1] },
    };
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++) {
        if (strcmp(same[i][1], same[i][2]) != 0) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: planned with %s %.12s, not %.12s, expected the same or a new "
                                 "table",
                                 folder->path, same[i][0], same[i][1], same[i][2]);
        }
    }
    return DIG_OK;
}

// The copies that the tasks read are still what was planned.
static enum dig_status check_copies(const struct dig_job_wanted *const wanted,
                                    const struct dig_job_folder *const folder,
                                    struct dig_error *const            error)
{
    char                   scene_path[PATH_MAX];
    char                   grid_path[PATH_MAX];
    char                   hash[65];
    struct dig_scene       scene;
    struct dig_plan        plan;
    struct dig_plan_point *point = NULL;
    const enum dig_status  status =
        dig_plan_read(dig_job_folder_file(folder, "scene.yaml", scene_path),
                      dig_job_folder_file(folder, "grid.yaml", grid_path), wanted->packings, &scene,
                      &plan, &point, error);
    if (status != DIG_OK) {
        return status;
    }
    dig_plan_hash(&plan, &scene, wanted->engine, hash);
    free(point);
    return strcmp(hash, folder->plan.digs_sha256) == 0
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "%s: changed, or %s: expected them as they were planned", scene_path,
                               grid_path);
}

static enum dig_status plan_of(const struct dig_job_wanted *const wanted,
                               struct dig_job_plan *const plan, struct dig_error *const error)
{
    struct dig_job_plan made = { .trajectories = wanted->plan->trajectories };
    for (size_t i = 0; i < wanted->plan->points; i++) {
        made.beds += wanted->plan->point[i].packings;
    }
    // A queue takes 1000 tasks an array unless its owner says otherwise (MaxArraySize 1001).
    made.tasks = wanted->tasks != 0 ? wanted->tasks : made.beds < 1000 ? made.beds : 1000;
    if (made.tasks > made.beds) {
        return dig_error_set(error, DIG_EINVAL,
                             "--tasks %zu: the grid has %zu beds, expected no "
                             "more tasks",
                             made.tasks, made.beds);
    }
    (void)snprintf(made.engine, sizeof made.engine, "%s", wanted->engine->name);
    (void)snprintf(made.version, sizeof made.version, "%s", wanted->engine->version);
    dig_plan_hash(wanted->plan, wanted->scene, wanted->engine, made.digs_sha256);
    *plan = made;
    return DIG_OK;
}

enum dig_status dig_job_plan_folder(const char *const                  table,
                                    const struct dig_job_wanted *const wanted,
                                    const volatile sig_atomic_t *const stop,
                                    struct dig_job_folder *const       folder,
                                    struct dig_error *const            error)
{
    assert(table != NULL && wanted != NULL && folder != NULL);
    struct dig_job_folder made = { .lock_fd = -1 };
    struct dig_job_plan   plan;
    char                  path[PATH_MAX];
    enum dig_status       status = plan_of(wanted, &plan, error);
    if (status == DIG_OK) {
        status = dig_job_folder_make(table, stop, &made, error);
    }
    if (status == DIG_OK) {
        made.plan = plan;
        status    = access(dig_job_folder_file(&made, "plan.yaml", path), F_OK) == 0
                        ? compare(wanted, &plan, &made, error)
                        : fill(wanted, &made, error);
    }
    if (status == DIG_OK) {
        status = check_copies(wanted, &made, error);
    }
    if (status != DIG_OK) {
        dig_job_folder_close(&made);
        return status;
    }
    *folder = made;
    return DIG_OK;
}
