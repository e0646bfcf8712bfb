#include "tools/digloop/scene.h"

#include "core/name.h"
#include "core/similar.h"
#include "files/scene_yaml.h"
#include "tables/scene.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static enum dig_status check_file(const char *const path, const char *const table,
                                  struct dig_scene *const scene, struct dig_scene *const own,
                                  struct dig_error *const error)
{
    enum dig_status status = dig_scene_read(path, scene, error);
    if (status == DIG_OK) {
        status = dig_table_scene(table, own, error);
    }
    return status == DIG_OK ? dig_error_name(error, dig_scene_similar(scene, own, error),
                                             "%s: scene \"%s\" is not similar to \"%s\" of %s",
                                             path, scene->name, own->name, table)
                            : status;
}

enum dig_status digloop_check_scene(const struct digloop_job *const job, const char *const path,
                                    double *const scale, struct dig_error *const error)
{
    assert(job != NULL && path != NULL && scale != NULL);

    // A scene may be named instead of given: then by the name the table has.
    if (access(path, F_OK) != 0) {
        const bool same = strcmp(dig_path_last(path), job->set->scene_name) == 0;
        *scale          = same ? 1.0 : *scale;
        return same ? DIG_OK
                    : dig_error_set(error, DIG_EINVAL,
                                    "%s: no such scene file, nor is it the scene \"%s\" of %s",
                                    path, job->set->scene_name, job->options->table);
    }
    struct dig_scene *const scene = calloc(2, sizeof *scene); // the file's, the table's
    if (scene == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    const enum dig_status status =
        check_file(path, job->options->table, &scene[0], &scene[1], error);
    if (status == DIG_OK) {
        *scale = dig_scene_scale(&scene[0], &scene[1]);
    }
    free(scene);
    return status;
}

enum dig_status digloop_check_bucket(const struct digloop_job *const job, const char *const file,
                                     const struct dig_machine *const machine,
                                     struct dig_error *const         error)
{
    assert(job != NULL && file != NULL && machine != NULL);
    return dig_error_name(error, dig_bucket_similar(machine, job->set, error), "%s does not fit %s",
                          file, job->options->table);
}
