// digreport: reports a run of the daemon, or a shift, from LCM logs.

#include "closed_loop/report/report.h"
#include "core/similar.h"
#include "core/streams.h"
#include "estimator/wrench/correction.h"
#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/text/whole.h"
#include "firmware_host/config/load_model.h"
#include "tables/load.h"
#include "tools/digreport/options.h"
#include "tools/digreport/run.h"
#include "tools/digreport/shift_page.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What the daemon had, as far as it was given. By the machine as the model corrects it a run's digs
// are measured again.
struct loaded {
    struct dig_machine    machine;
    struct dig_curve_set *set;
    double                lambda; // the machine's tooth length over the table's; 0: not known
    struct dig_corrected_machine corrected;
    struct dig_model             model; // of a shift
};

static enum dig_status load(const struct digreport_options *const options, struct loaded *const had,
                            struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    if (options->machine != NULL) {
        status = dig_machine_read(options->machine, &had->machine, error);
    }
    if (status == DIG_OK && options->table != NULL) {
        status = dig_table_load(options->table, &had->set, error);
    }
    // Scale and curves hold for a bucket of the table's shape alone.
    if (status == DIG_OK && had->set != NULL) {
        status      = dig_error_name(error, dig_bucket_similar(&had->machine, had->set, error),
                                     "%s does not fit %s", options->machine, options->table);
        had->lambda = had->machine.link[DIG_JOINT_BUCKET].length_m / had->set->tooth_m;
    }
    if (status == DIG_OK && options->model != NULL) {
        status = options->shift ? dig_model_read(options->model, &had->model, error)
                                : dig_load_model(options->model, options->table, &had->machine,
                                                 had->set, &had->corrected, error);
    }
    return dig_status_of_input(status);
}

// Where a program is to read the result, people read on standard error.
static FILE *for_people(const struct digreport_options *const o)
{
    return o->json != NULL || dig_out_is_stdout(o->csv) || dig_out_is_stdout(o->html) ? stderr
                                                                                      : stdout;
}

static enum dig_status report_runs(const struct digreport_options *const options,
                                   const struct loaded *const had, struct dig_error *const error)
{
    // Some 40 kB a run: too much to leave to the stack's good will.
    struct dig_report *const all = calloc(1, sizeof *all);
    if (all == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = DIG_OK;
    struct dig_out  out;
    all->title  = options->title != NULL ? options->title : "What the ground resisted with";
    all->table  = options->table;
    all->lambda = had->lambda;
    for (size_t i = 0; i < options->logs && status == DIG_OK; i++) {
        status = digreport_run(options, &had->machine, &had->corrected, had->set, options->log[i],
                               &all->run[i], error);
        all->runs += status == DIG_OK ? 1 : 0;
    }
    status = dig_status_of_input(status);
    if (dig_out_begin(&out, options->html, &status, error)) {
        status = dig_out_end(&out, dig_report_html(all, out.file, error), error);
    }
    if (dig_out_begin(&out, options->json, &status, error)) {
        dig_report_json(all, out.file);
        status = dig_out_commit(&out, error);
    }
    if (status == DIG_OK && !options->quiet) {
        dig_report_text(all, for_people(options));
    }
    free(all);
    return status;
}

static enum dig_status write_shift(const struct digreport_options *const       options,
                                   const struct digreport_shift *const         shift,
                                   const struct digreport_shift_subject *const subject,
                                   struct dig_error *const                     error)
{
    struct dig_out  out;
    enum dig_status status = DIG_OK;
    if (dig_out_begin(&out, options->html, &status, error)) {
        status = dig_out_end(&out, digreport_shift_html(shift, subject, out.file, error), error);
    }
    if (dig_out_begin(&out, options->csv, &status, error)) {
        digreport_shift_csv(shift, out.file);
        status = dig_out_commit(&out, error);
    }
    if (dig_out_begin(&out, options->json, &status, error)) {
        digreport_shift_json(shift, out.file);
        status = dig_out_commit(&out, error);
    }
    if (status == DIG_OK && !options->quiet) {
        FILE *const to = for_people(options);
        digreport_shift_sentence(shift, to);
        (void)fputs("\n", to);
    }
    return status;
}

static enum dig_status report_shift(const struct digreport_options *const options,
                                    const struct loaded *const had, struct dig_error *const error)
{
    struct digreport_shift shift;
    enum dig_status        status = DIG_OK;
    digreport_shift_begin(&shift, had->lambda);
    for (size_t i = 0; i < options->logs && status == DIG_OK; i++) {
        status = digreport_shift_log(&shift, options->log[i], error);
    }
    if (status == DIG_OK && had->set != NULL && shift.scene_hash[0] != '\0' &&
        strcmp(shift.scene_hash, had->set->scene_hash) != 0) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s is of scene %.12s…, the daemon of the log predicted from scene "
                               "%.12s…, expected one scene",
                               options->table, had->set->scene_hash, shift.scene_hash);
    }
    status = dig_status_of_input(status);
    if (status == DIG_OK) {
        const struct digreport_shift_subject subject = {
            .title   = options->title != NULL ? options->title : "Shift report",
            .machine = had->machine.name,
            .scene   = had->set != NULL ? had->set->scene_name : "",
            .model   = options->model != NULL ? &had->model : NULL,
            .logs    = options->logs,
        };
        status = write_shift(options, &shift, &subject, error);
    }
    digreport_shift_finish(&shift);
    return status;
}

int main(const int argc, char *argv[])
{
    struct digreport_options options = { .logs = 0 };
    struct dig_error         error   = { "" };
    dig_streams_begin();
    if (digreport_parse(argc, argv, &options, &error) != DIG_OK) {
        return digreport_refuse(argv[1], &error);
    }
    struct loaded   had    = { .set = NULL };
    enum dig_status status = load(&options, &had, &error);
    if (status == DIG_OK) {
        status = options.shift ? report_shift(&options, &had, &error)
                               : report_runs(&options, &had, &error);
    }
    dig_model_finish(&had.model);
    dig_curve_set_destroy(had.set);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digreport: %s\n", error.text);
    }
    return dig_streams_end("digreport", status == DIG_OK ? EXIT_SUCCESS
                                        : (status == DIG_EINVAL || status == DIG_ESCHEMA)
                                            ? 2
                                            : EXIT_FAILURE);
}
