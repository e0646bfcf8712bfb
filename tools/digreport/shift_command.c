#include "tools/digreport/shift_command.h"

#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/whole.h"
#include "tables/load.h"
#include "tools/digreport/shift_page.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "digreport shift shows what a shift was like, from the LCM logs of digsightd: digs, gravel,\n"
    "peak and energy, error of the predictions, effects of the model, troubles.\n"
    "\n"
    "usage:\n"
    "  digreport shift --table TABLE.sqlite --machine MACHINE.yaml [--model MODEL.json]\n"
    "                  [--title TEXT] [--html PAGE.html] [--csv DIGS.csv] LOG.lcm…\n"
    "      Logs in the order in which they were written. --table, --machine and --model: what the\n"
    "      daemon ran on. --csv: a line a dig (docs/formats.md).\n"
    "\n"
    "One sentence goes to standard output. Exit codes: 0 done, 1 the work failed, 2 bad usage or\n"
    "bad input.\n"
    "\n"
    "examples:\n"
    "  digreport shift --table tables/rig.sqlite --machine config/machines/zx200_trench.yaml \\\n"
    "                  --html shift.html --csv shift.csv morning.lcm afternoon.lcm\n";

struct options {
    const char *table, *machine, *model, *title, *html, *csv;
};

static enum dig_status parse(const int argc, char *argv[], struct options *const options,
                             struct dig_error *const error)
{
    enum { TABLE = 256, MACHINE, MODEL, TITLE, HTML, CSV, HELP };
    static const struct option known[] = {
        { "table", required_argument, NULL, TABLE },
        { "machine", required_argument, NULL, MACHINE },
        { "model", required_argument, NULL, MODEL },
        { "title", required_argument, NULL, TITLE },
        { "html", required_argument, NULL, HTML },
        { "csv", required_argument, NULL, CSV },
        { "help", no_argument, NULL, HELP },
        { NULL, 0, NULL, 0 },
    };
    struct options o = { .title = "Shift report" };
    opterr           = 0;
    for (int c; (c = getopt_long(argc, argv, "", known, NULL)) != -1;) {
        switch (c) {
        case TABLE: o.table = optarg; break;
        case MACHINE: o.machine = optarg; break;
        case MODEL: o.model = optarg; break;
        case TITLE: o.title = optarg; break;
        case HTML: o.html = optarg; break;
        case CSV: o.csv = optarg; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
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
