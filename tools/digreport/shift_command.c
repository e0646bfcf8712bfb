#include "tools/digreport/shift_command.h"

#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/text/whole.h"
#include "tables/load.h"
#include "tools/digreport/shift_page.h"

#include <stdio.h>

static enum dig_status write_file(const struct digreport_shift *const shift, const char *const path,
                                  void (*const put)(const struct digreport_shift *, FILE *),
                                  struct dig_error *const error)
{
    if (path == NULL) {
        return DIG_OK;
    }
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    put(shift, out.file);
    return dig_out_commit(&out, error);
}

static enum dig_status report(const struct digreport_options *const       options,
                              const struct digreport_shift *const         shift,
                              const struct digreport_shift_subject *const subject,
                              struct dig_error *const                     error)
{
    struct dig_out  out;
    enum dig_status status =
        options->html != NULL ? dig_out_open(&out, options->html, error) : DIG_OK;
    if (status == DIG_OK && options->html != NULL) {
        status = dig_out_end(&out, digreport_shift_html(shift, subject, out.file, error), error);
    }
    if (status == DIG_OK) {
        status = write_file(shift, options->csv, digreport_shift_csv, error);
    }
    if (status == DIG_OK) {
        status = write_file(shift, options->json, digreport_shift_json, error);
    }
    if (status == DIG_OK && !options->quiet) {
        // Where a program is to read the result, people read on standard error.
        FILE *const to = options->json != NULL || dig_out_is_stdout(options->csv) ||
                                 dig_out_is_stdout(options->html)
                             ? stderr
                             : stdout;
        digreport_shift_sentence(shift, to);
        (void)fputs("\n", to);
    }
    return status;
}

enum dig_status digreport_shift_command(const struct digreport_options *const options,
                                        struct dig_error *const               error)
{
    struct dig_machine     machine = { .name = "" };
    struct dig_model       model   = { .effects = 0 };
    struct dig_curve_set  *set     = NULL;
    struct digreport_shift shift;
    enum dig_status        status = DIG_OK;
    digreport_shift_begin(&shift, 0.0);
    if (options->machine != NULL) {
        status = dig_machine_read(options->machine, &machine, error);
    }
    if (status == DIG_OK && options->model != NULL) {
        status = dig_model_read(options->model, &model, error);
    }
    if (status == DIG_OK && options->table != NULL) {
        status = dig_table_load(options->table, &set, error);
    }
    if (status == DIG_OK && set != NULL) {
        digreport_shift_begin(&shift, machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m);
    }
    for (size_t i = 0; i < options->logs && status == DIG_OK; i++) {
        status = digreport_shift_log(&shift, options->log[i], error);
    }
    status = digreport_input(status);
    if (status == DIG_OK) {
        const struct digreport_shift_subject subject = {
            .title   = options->title != NULL ? options->title : "Shift report",
            .machine = machine.name,
            .scene   = set != NULL ? set->scene_name : "",
            .model   = options->model != NULL ? &model : NULL,
            .logs    = options->logs,
        };
        status = report(options, &shift, &subject, error);
    }
    digreport_shift_finish(&shift);
    dig_model_finish(&model);
    dig_curve_set_destroy(set);
    return status;
}
