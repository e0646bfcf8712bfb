// digloop design: ranks the simple digs of a table by their information on the gravel.

#include "closed_loop/design/design.h"

#include "closed_loop/report/design_report.h"
#include "tools/digloop/commands.h"

#include <stdlib.h>

enum { DRAWS = 400, SEED = 1 };

enum dig_status digloop_design(const struct digloop_job *const job, struct dig_error *const error)
{
    struct dig_response_surface *const surface = calloc(1, sizeof *surface);
    struct dig_design *const           design  = calloc(1, sizeof *design);
    struct dig_scatter                *scatter = NULL;
    enum dig_status status = surface != NULL && design != NULL ? DIG_OK : DIG_ENOMEM;
    if (status == DIG_OK) {
        status = dig_response_surface_fit(job->set, surface);
    }
    if (status != DIG_OK) {
        (void)dig_error_set(error, status, "%s: too few entries for a surface over the gravel",
                            job->options->table);
        goto done;
    }
    status = dig_scatter_measure(job->options->table, surface, &scatter, error);
    if (status != DIG_OK) {
        goto done;
    }
    status = dig_design_run(surface, scatter, DRAWS, SEED, design);
    if (status != DIG_OK) {
        (void)dig_error_set(error, status, "%s: holds no simple trajectory, expected one or more",
                            job->options->table);
    } else if (job->options->json) {
        dig_design_json(design, job->set, stdout);
    } else {
        dig_design_text(design, job->set, stdout);
    }
done:
    dig_scatter_destroy(scatter);
    free(design);
    free(surface);
    return status;
}
