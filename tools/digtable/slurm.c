#include "tools/digtable/slurm.h"

#include "core/process.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

// Runs one of Slurm's commands; what it says is *out, to be closed, on success only.
static enum dig_status ask(const char *const argv[const], const char *const without,
                           FILE **const out, struct dig_error *const error)
{
    FILE *const file = tmpfile();
    if (file == NULL) {
        return dig_error_set(error, DIG_EIO, "a temporary file: %s", strerror(errno));
    }
    const struct dig_process process = { .argv = argv, .without = without, .out = file };
    const enum dig_status    status  = dig_process_run(&process, error);
    if (status != DIG_OK) {
        (void)fclose(file);
        return status;
    }
    rewind(file);
    *out = file;
    return DIG_OK;
}

enum dig_status dig_slurm_check(struct dig_error *const error)
{
    static const char *const programs[] = { "sbatch", "squeue" };
    for (size_t i = 0; i < sizeof programs / sizeof programs[0]; i++) {
        const char *const argv[] = { programs[i], "--version", NULL };
        FILE             *out    = NULL;
        if (ask(argv, NULL, &out, error) != DIG_OK) {
            return DIG_EINVAL;
        }
        (void)fclose(out);
    }
    return DIG_OK;
}

void dig_slurm_read_queue(FILE *const lines, const size_t tasks, enum dig_shard_state shard[const])
{
    char line[128];
    while (fgets(line, sizeof line, lines) != NULL) {
        char               *end   = NULL;
        const unsigned long task  = strtoul(line, &end, 10);
        const bool          merge = strncmp(line, "N/A ", 4) == 0;
        const char *const   state = merge ? line + 4 : end + 1;
        if (merge || (end > line && *end == ' ' && task >= 1 && task <= tasks)) {
            shard[merge ? DIG_JOB_MERGE : task] =
                strncmp(state, "PD", 2) == 0 ? DIG_SHARD_PENDING : DIG_SHARD_RUNNING;
        }
    }
}

enum dig_status dig_slurm_queue(const struct dig_job_plan *const plan,
                                enum dig_shard_state shard[const], struct dig_error *const error)
{
    char name[16 + DIG_JOB_TEXT_SIZE];
    (void)snprintf(name, sizeof name, "--name=%s", plan->job);
    const char *const argv[] = { "squeue", "--noheader",     "--array", "--all",
                                 name,     "--format=%K %t", NULL };
    FILE             *out    = NULL;
    // A filter of the user's own, SQUEUE_PARTITION say, would hide a job, and it would run twice.
    const enum dig_status status = ask(argv, "SQUEUE_", &out, error);
    if (status == DIG_OK) {
        dig_slurm_read_queue(out, plan->tasks, shard);
        (void)fclose(out);
    }
    return status;
}

bool dig_slurm_ranges(const size_t tasks, const bool submit[const], const size_t size,
                      char text[const])
{
    size_t used = 0;
    text[0]     = '\0';
    for (size_t from = 1; from <= tasks; from++) {
        size_t to = from;
        if (!submit[from]) {
            continue;
        }
        while (to < tasks && submit[to + 1]) {
            to++;
        }
        const int length =
            to > from
                ? snprintf(text + used, size - used, "%s%zu-%zu", used > 0 ? "," : "", from, to)
                : snprintf(text + used, size - used, "%s%zu", used > 0 ? "," : "", from);
        used += (size_t)length;
        if (used >= size) {
            return false;
        }
        from = to;
    }
    return true;
}

// sbatch of run.sh. Ours stand behind the user's: of an option given twice the last one counts.
static enum dig_status sbatch(const struct dig_arguments *const  a,
                              const struct dig_job_folder *const folder, const char *const which,
                              const char *const log, const char *const task, char id[const 64],
                              struct dig_error *const error)
{
    char        name[16 + DIG_JOB_TEXT_SIZE];
    char        chdir[PATH_MAX + 16];
    char        path[PATH_MAX];
    const char *argv[DIG_PROCESS_ARGUMENTS_MAX + 1] = { "sbatch", "--parsable" };
    size_t      n                                   = 2;
    (void)snprintf(name, sizeof name, "--job-name=%s", folder->plan.job);
    (void)snprintf(chdir, sizeof chdir, "--chdir=%s", folder->path);
    const char *const asked[][2] = { { "--time", a->time }, { "--partition", a->partition } };
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++) {
        if (asked[i][1] != NULL) {
            argv[n++] = asked[i][0];
            argv[n++] = asked[i][1];
        }
    }
    for (size_t i = 0; i < a->sbatch_args; i++) {
        argv[n++] = a->sbatch_arg[i];
    }
    const char *const ours[] = { name,  chdir,
                                 log,   "--open-mode=truncate",
                                 which, dig_job_folder_file(folder, "run.sh", path),
                                 task };
    for (size_t i = 0; i < sizeof ours / sizeof ours[0] && ours[i] != NULL; i++) {
        argv[n++] = ours[i];
    }
    argv[n]                      = NULL;
    FILE                 *out    = NULL;
    const enum dig_status status = ask(argv, NULL, &out, error);
    if (status == DIG_OK) {
        dig_process_last_line(out, 64, id);
        (void)fclose(out);
    }
    return status == DIG_EIO ? DIG_EINVAL : status;
}

// For people, and so that the queue is asked from here on; it is asked by the name.
static enum dig_status remember(const struct dig_job_folder *const folder, const char *const line,
                                const char *const what, struct dig_error *const error)
{
    char        path[PATH_MAX];
    FILE *const file = fopen(dig_job_folder_file(folder, "slurm", path), "a");
    const bool  put = file != NULL && (line[0] == '\0' || fprintf(file, "%s %s\n", line, what) > 0);
    const bool  ok  = file != NULL && fclose(file) == 0 && put;
    return ok ? DIG_OK : dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
}

enum dig_status dig_slurm_submit(const struct dig_arguments *const  a,
                                 const struct dig_job_folder *const folder,
                                 const bool submit[const], char id[const 64],
                                 struct dig_error *const error)
{
    char array[60000 + 16] = "--array=";
    char merge[64]         = "";
    id[0]                  = '\0';
    if (strpbrk(folder->path, "%\\") != NULL) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: expected a path without %% and \\, which Slurm replaces in names",
                             folder->path);
    }
    if (!dig_slurm_ranges(folder->plan.tasks, submit, sizeof array - 8, array + 8)) {
        return dig_error_set(error, DIG_EINVAL, "%zu tasks: too many to name those missing",
                             folder->plan.tasks);
    }
    enum dig_status status = remember(folder, "", "", error);
    if (status == DIG_OK && array[8] != '\0') {
        status = sbatch(a, folder, array, "--output=log/%a.log", NULL, id, error);
        if (status == DIG_OK) {
            status = remember(folder, id, array + 8, error);
        }
    }
    // After all jobs of the name that were submitted before, be they done or failed.
    if (status == DIG_OK) {
        status = sbatch(a, folder, "--dependency=singleton", "--output=log/merge.log", "merge",
                        merge, error);
    }
    if (status == DIG_OK && id[0] == '\0') {
        memcpy(id, merge, sizeof merge);
    }
    return status == DIG_OK ? remember(folder, merge, "merge", error) : status;
}
