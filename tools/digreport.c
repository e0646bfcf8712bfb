// digreport: reports a run of the daemon from its LCM log.

#include "closed_loop/report/report.h"
#include "estimator/wrench/correction.h"
#include "files/machine_yaml.h"
#include "files/text/whole.h"
#include "firmware_host/config/load_model.h"
#include "tables/load.h"
#include "tools/digreport/options.h"
#include "tools/digreport/run.h"
#include "tools/digreport/shift_command.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

// What the daemon had: machine, table and, where it ran with one, the model, by which the digs are
// measured again.
struct loaded {
    struct dig_machine    machine;
    struct dig_curve_set *set;
    struct dig_correction correction;
    bool                  corrects;
};

static enum dig_status load(const struct digreport_options *const options, struct loaded *const had,
                            struct dig_error *const error)
{
    enum dig_status status = dig_machine_read(options->machine, &had->machine, error);
    if (status == DIG_OK) {
        status = dig_table_load(options->table, &had->set, error);
    }
    if (status == DIG_OK && options->model != NULL) {
        status = dig_load_model(options->model, options->table, &had->machine, had->set,
                                &had->correction, &had->corrects, error);
    }
    return digreport_input(status);
}

static enum dig_status report(const struct digreport_options *const options,
                              struct dig_error *const               error)
{
    struct dig_report *all    = NULL;
    struct loaded      had    = { .set = NULL };
    enum dig_status    status = load(options, &had, error);
    if (status != DIG_OK) {
        goto done;
    }

    // Some 40 kB a run: too much to leave to the stack's good will.
    all = calloc(1, sizeof *all);
    if (all == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "out of memory");
        goto done;
    }
    all->title  = options->title != NULL ? options->title : "What the ground resisted with";
    all->table  = options->table;
    all->lambda = had.machine.link[DIG_JOINT_BUCKET].length_m / had.set->tooth_m;
    for (size_t i = 0; i < options->logs && status == DIG_OK; i++) {
        status = digreport_run(options, &had.machine, had.corrects ? &had.correction : NULL,
                               had.set, options->log[i], &all->run[i], error);
        all->runs += status == DIG_OK ? 1 : 0;
    }
    status = digreport_input(status);
    struct dig_out out;
    if (status == DIG_OK && options->html != NULL) {
        status = dig_out_open(&out, options->html, error);
        if (status == DIG_OK) {
            status = dig_out_end(&out, dig_report_html(all, out.file, error), error);
        }
    }
    if (status == DIG_OK && options->json != NULL) {
        status = dig_out_open(&out, options->json, error);
        if (status == DIG_OK) {
            dig_report_json(all, out.file);
            status = dig_out_commit(&out, error);
        }
    }
    if (status == DIG_OK && !options->quiet) {
        // Where a program is to read the result, people read on standard error.
        const bool read = options->json != NULL || dig_out_is_stdout(options->html);
        dig_report_text(all, read ? stderr : stdout);
    }
done:
    free(all);
    dig_curve_set_destroy(had.set);
    return status;
}

int main(const int argc, char *argv[])
{
    struct digreport_options options = { .logs = 0 };
    struct dig_error         error   = { "" };
    enum dig_status          status  = digreport_parse(argc, argv, &options, &error);
    if (status == DIG_OK) {
        status =
            options.shift ? digreport_shift_command(&options, &error) : report(&options, &error);
    }
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digreport: %s\n", error.text);
    }
    return status == DIG_OK                                  ? EXIT_SUCCESS
           : (status == DIG_EINVAL || status == DIG_ESCHEMA) ? 2
                                                             : EXIT_FAILURE;
}
