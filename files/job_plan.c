#include "files/job_plan.h"

#include "core/curve.h"
#include "core/name.h"
#include "files/text/whole.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

#define BEDS_MAX 10000000

struct plan_text {
    char     job[DIG_JOB_TEXT_SIZE];
    char     digs_sha256[65];
    char     engine[DIG_JOB_TEXT_SIZE];
    char     version[DIG_JOB_TEXT_SIZE];
    uint32_t tasks, beds, trajectories;
};

#define REQUIRED CYAML_FLAG_DEFAULT

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_STRING("job", REQUIRED, struct plan_text, job, 1),
    CYAML_FIELD_STRING("digs_sha256", REQUIRED, struct plan_text, digs_sha256, 64),
    CYAML_FIELD_STRING("engine", REQUIRED, struct plan_text, engine, 1),
    CYAML_FIELD_STRING("version", REQUIRED, struct plan_text, version, 1),
    CYAML_FIELD_UINT("tasks", REQUIRED, struct plan_text, tasks),
    CYAML_FIELD_UINT("beds", REQUIRED, struct plan_text, beds),
    CYAML_FIELD_UINT("trajectories", REQUIRED, struct plan_text, trajectories),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct plan_text, fields) };

static enum dig_status check(const char *const path, const struct plan_text *const text,
                             struct dig_error *const error)
{
    // It stands in command lines and is what a queue is asked for.
    if (!dig_name_ok(text->job)) {
        return dig_yaml_refuse(path, error, "job: \"%s\", expected " DIG_NAME_RULE, text->job);
    }
    if (text->tasks < 1 || text->tasks > DIG_JOB_TASKS_MAX) {
        return dig_yaml_refuse(path, error, "tasks: %u, expected 1 to %d", text->tasks,
                               DIG_JOB_TASKS_MAX);
    }
    if (text->beds < text->tasks || text->beds > BEDS_MAX) {
        return dig_yaml_refuse(path, error, "beds: %u, expected %u (the tasks) to %d", text->beds,
                               text->tasks, BEDS_MAX);
    }
    if (text->trajectories < 1 || text->trajectories > DIG_TRAJECTORY_MAX) {
        return dig_yaml_refuse(path, error, "trajectories: %u, expected 1 to %d",
                               text->trajectories, DIG_TRAJECTORY_MAX);
    }
    return DIG_OK;
}

enum dig_status dig_job_plan_read(const char *const path, struct dig_job_plan *const plan,
                                  struct dig_error *const error)
{
    assert(path != NULL && plan != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    const struct plan_text *const text = data;
    status                             = check(path, text, error);
    if (status == DIG_OK) {
        struct dig_job_plan read = { .tasks        = text->tasks,
                                     .beds         = text->beds,
                                     .trajectories = text->trajectories };
        memcpy(read.job, text->job, sizeof read.job);
        memcpy(read.digs_sha256, text->digs_sha256, sizeof read.digs_sha256);
        memcpy(read.engine, text->engine, sizeof read.engine);
        memcpy(read.version, text->version, sizeof read.version);
        *plan = read;
    }
    dig_yaml_free(&schema, data);
    return status;
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
