#include "tools/digreport/shift_command.h"

#include "core/help.h"
#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/text/whole.h"
#include "tables/load.h"
#include "tools/digreport/options.h"
#include "tools/digreport/shift_page.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    const char *table, *machine, *model, *title, *html, *csv, *json;
    bool        quiet;
};

static enum dig_status parse(const int argc, char *argv[], struct options *const options,
                             struct dig_error *const error)
{
    const struct dig_program *const program = digreport_program();
    const struct dig_command *const command = dig_command_find(program, "shift", error);
    struct options                  o       = { .title = "Shift report" };
    for (int c; (c = dig_option_next(program, command, argc, argv, error)) != DIG_OPTION_END;) {
        switch (c) {
        case DIGREPORT_TABLE: o.table = optarg; break;
        case DIGREPORT_MACHINE: o.machine = optarg; break;
        case DIGREPORT_MODEL: o.model = optarg; break;
        case DIGREPORT_TITLE: o.title = optarg; break;
        case DIGREPORT_HTML: o.html = optarg; break;
        case DIGREPORT_CSV: o.csv = optarg; break;
        case DIGREPORT_JSON: o.json = optarg; break;
        case DIGREPORT_QUIET: o.quiet = true; break;
        case DIG_OPTION_HELP: dig_help_print(program, command, stdout); exit(EXIT_SUCCESS);
        case DIG_OPTION_VERSION: (void)puts("digreport " DIG_VERSION); exit(EXIT_SUCCESS);
        default: return DIG_EINVAL; // said already
        }
    }
    if (optind == argc) {
        return dig_error_set(error, DIG_EINVAL, "shift: expected at least one LOG.lcm");
    }
    if ((o.table == NULL) != (o.machine == NULL)) {
        return dig_error_set(error, DIG_EINVAL,
                             "shift: expected --table and --machine, or neither: both tell how "
                             "much larger the machine is than the rig");
    }
    if (dig_out_is_stdout(o.html) + dig_out_is_stdout(o.csv) + dig_out_is_stdout(o.json) > 1) {
        return dig_error_set(error, DIG_EINVAL,
                             "shift: two results on standard output, expected one");
    }
    *options = o;
    return DIG_OK;
}

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

static enum dig_status report(const struct options *const                 options,
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

enum dig_status digreport_shift_command(const int argc, char *argv[], struct dig_error *const error)
{
    struct options         options = { .table = NULL };
    struct dig_machine     machine = { .name = "" };
    struct dig_model       model   = { .effects = 0 };
    struct dig_curve_set  *set     = NULL;
    struct digreport_shift shift;
    enum dig_status        status = parse(argc, argv, &options, error);
    digreport_shift_begin(&shift, 0.0);
    if (status == DIG_OK && options.machine != NULL) {
        status = dig_machine_read(options.machine, &machine, error);
    }
    if (status == DIG_OK && options.model != NULL) {
        status = dig_model_read(options.model, &model, error);
    }
    if (status == DIG_OK && options.table != NULL) {
        status = dig_table_load(options.table, &set, error);
    }
    if (status == DIG_OK && set != NULL) {
        digreport_shift_begin(&shift, machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m);
    }
    for (int i = optind; i < argc && status == DIG_OK; i++) {
        status = digreport_shift_log(&shift, argv[i], error);
    }
    status = digreport_input(status);
    if (status == DIG_OK) {
        const struct digreport_shift_subject subject = {
            .title   = options.title,
            .machine = machine.name,
            .scene   = set != NULL ? set->scene_name : "",
            .model   = options.model != NULL ? &model : NULL,
            .logs    = (size_t)(argc - optind),
        };
        status = report(&options, &shift, &subject, error);
    }
    digreport_shift_finish(&shift);
    dig_model_finish(&model);
    dig_curve_set_destroy(set);
    return status;
}
