// run.sh of a job folder.

#include "core/shell.h"
#include "files/text/whole.h"
#include "tools/digtable/job_planning.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Quotes make a path at most so much longer.
#define WORD_SIZE (32 * PATH_MAX)

static void put_word(FILE *const to, const char *const name, const char *const word)
{
    char quoted[WORD_SIZE];
    (void)dig_shell_word(word, sizeof quoted, quoted);
    (void)fprintf(to, "%s%s\n", name, quoted);
}

static void put_script(FILE *const to, const struct dig_job_folder *const folder,
                       const char *const program, const size_t packings)
{
    const struct dig_job_plan *const plan = &folder->plan;
    (void)fprintf(
        to,
        "#!/bin/sh\n"
        "# `sh run.sh I` computes shard I of %zu, `sh run.sh merge` puts all of them into "
        "the table.\n"
        "# `digtable submit` wrote this. Slurm runs it as a job array.\n"
        "set -eu\n",
        plan->tasks);
    put_word(to, "digtable=", program);
    put_word(to, "table=", folder->table);
    put_word(to, "cd ", folder->path);
    (void)fprintf(
        to,
        "task=${1-$SLURM_ARRAY_TASK_ID}\n"
        "[ -n \"${SLURM_JOB_ID-}\" ] || { rm -f \"log/$task.log\"; exec >\"log/$task.log\" 2>&1; "
        "}\n\n"
        "if [ \"$task\" = merge ]; then\n"
        "    [ ! -e \"$table\" ] || exit 0\n"
        "    [ \"$(ls shards | grep -c '^[0-9]*\\.sqlite$')\" -eq %zu ] || {\n"
        "        echo \"run.sh: not all shards are there, digtable status says which\" >&2\n"
        "        exit 1\n"
        "    }\n"
        "    exec \"$digtable\" merge \"$table\" shards\n"
        "fi\n\n"
        "[ ! -e \"shards/$task.sqlite\" ] || exit 0\n"
        "\"$digtable\" generate scene.yaml grid.yaml -o \"part/$task.sqlite\" "
        "--shard \"$task/%zu\" \\\n"
        "    --jobs \"${SLURM_CPUS_PER_TASK:-1}\" --engine %s --quiet",
        plan->tasks, plan->tasks, plan->engine);
    if (packings > 0) {
        (void)fprintf(to, " --packings %zu", packings);
    }
    (void)fputs("\nmv \"part/$task.sqlite\" shards\n", to);
}

enum dig_status dig_job_script_write(const struct dig_job_folder *const folder,
                                     const size_t packings, struct dig_error *const error)
{
    char           path[PATH_MAX];
    char           program[PATH_MAX];
    struct dig_out out;
    const ssize_t  length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) {
        return dig_error_set(error, DIG_EIO, "/proc/self/exe: %s", strerror(errno));
    }
    program[length] = '\0';
    const enum dig_status status =
        dig_out_open(&out, dig_job_folder_file(folder, "run.sh", path), error);
    if (status != DIG_OK) {
        return status;
    }
    put_script(out.file, folder, program, packings);
    return dig_out_commit(&out, error);
}
