#include "tools/digreport/shift_command.h"

#include "core/help.h"
#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/whole.h"
#include "tables/load.h"
#include "tools/digreport/options.h"
#include "tools/digreport/shift_page.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    const char *table, *machine, *model, *title, *html, *csv;
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
        case DIG_OPTION_HELP: dig_help_print(program, command, stdout); exit(EXIT_SUCCESS);
        case DIG_OPTION_VERSION: (void)puts("digreport " DIG_VERSION); exit(EXIT_SUCCESS);
        default: return DIG_EINVAL; // said already
        }
    }
    if (o.table == NULL || o.machine == NULL || optind == argc) {
        return dig_error_set(error, DIG_EINVAL,
                             "shift: expected --table, --machine and at least one LOG.lcm");
    }
    *options = o;
    return DIG_OK;
}

static enum dig_status write_csv(const struct digreport_shift *const shift, const char *const path,
                                 struct dig_error *const error)
{
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    digreport_shift_csv(shift, out.file);
    return dig_out_commit(&out, error);
}

static enum dig_status report(const struct options *const                 options,
                              const struct digreport_shift *const         shift,
                              const struct digreport_shift_subject *const subject,
                              struct dig_error *const                     error)
{
    enum dig_status status = DIG_OK;
    if (options->html != NULL) {
        status = digreport_shift_html(shift, subject, options->html, error);
    }
    if (status == DIG_OK && options->csv != NULL) {
        status = write_csv(shift, options->csv, error);
    }
    if (status == DIG_OK) {
        digreport_shift_sentence(shift, stdout);
        (void)fputs("\n", stdout);
    }
    return status;
}

enum dig_status digreport_shift_command(const int argc, char *argv[], struct dig_error *const error)
{
    struct options         options = { .table = NULL };
    struct dig_machine     machine;
    struct dig_model       model  = { .effects = 0 };
    struct dig_curve_set  *set    = NULL;
    struct digreport_shift shift  = { .lambda = 0.0 };
    enum dig_status        status = parse(argc, argv, &options, error);
    if (status == DIG_OK) {
        status = dig_machine_read(options.machine, &machine, error);
    }
    if (status == DIG_OK && options.model != NULL) {
        status = dig_model_read(options.model, &model, error);
    }
    if (status == DIG_OK) {
        status = dig_table_load(options.table, &set, error);
    }
    if (status == DIG_OK) {
        shift.lambda       = machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
        shift.track.half_s = DIG_SMOOTH_HALF_s * sqrt(shift.lambda);
    }
    for (int i = optind; i < argc && status == DIG_OK; i++) {
        status = digreport_shift_log(&shift, argv[i], error);
    }
    if (status == DIG_OK) {
        const struct digreport_shift_subject subject = {
            .title   = options.title,
            .machine = machine.name,
            .scene   = set->scene_name,
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
