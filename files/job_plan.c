#include "files/job_plan.h"

#include "core/curve.h"
#include "core/name.h"
#include "files/text/whole.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <stdio.h>

#define BEDS_MAX 10000000

#define WHOLE(member, least, most_)                                                                \
    FIELD(COUNT, #member, dig_job_plan, member, REQUIRED, .low = (least), .high = (most_))

static const struct dig_yaml_field fields[] = {
    TEXT(dig_job_plan, job),
    FIELD(TEXT, "digs_sha256", dig_job_plan, digs_sha256, REQUIRED, .least = 64),
    TEXT(dig_job_plan, engine),
    TEXT(dig_job_plan, version),
    WHOLE(tasks, 1, DIG_JOB_TASKS_MAX),
    WHOLE(beds, 1, BEDS_MAX),
    WHOLE(trajectories, 1, DIG_TRAJECTORY_MAX),
    END,
};

static const struct dig_yaml_file schema = { .of = fields, .size = sizeof(struct dig_job_plan) };

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    const struct dig_job_plan *const plan = loaded;
    (void)path;
    // It stands in command lines and is what a queue is asked for.
    dig_require(c, dig_name_ok(plan->job), "job: \"%s\", expected " DIG_NAME_RULE, plan->job);
    dig_require(c, plan->beds >= plan->tasks, "beds: %zu, expected %zu (the tasks) or more",
                plan->beds, plan->tasks);
}

enum dig_status dig_job_plan_read(const char *const path, struct dig_job_plan *const plan,
                                  struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, plan, error);
}

enum dig_status dig_job_plan_write(const char *const path, const struct dig_job_plan *const plan,
                                   struct dig_error *const error)
{
    assert(path != NULL && plan != NULL);
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)fprintf(out.file,
                  "# What the shards in this folder are parts of; `digtable submit` wrote it.\n"
                  "job: %s\ndigs_sha256: %s\nengine: \"%s\"\nversion: \"%s\"\n"
                  "tasks: %zu\nbeds: %zu\ntrajectories: %zu\n",
                  plan->job, plan->digs_sha256, plan->engine, plan->version, plan->tasks,
                  plan->beds, plan->trajectories);
    return dig_out_commit(&out, error);
}

size_t dig_job_plan_digs(const struct dig_job_plan *const plan, const size_t task)
{
    assert(task >= 1 && task <= plan->tasks);
    const size_t beds = plan->beds / plan->tasks + (task <= plan->beds % plan->tasks ? 1 : 0);
    return beds * plan->trajectories;
}
