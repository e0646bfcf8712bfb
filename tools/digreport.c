// digreport: reports a run of the daemon, or a shift, from LCM logs.

#include "closed_loop/report/report.h"
#include "core/command_line.h"
#include "core/did_you_mean.h"
#include "core/similar.h"
#include "core/streams.h"
#include "estimator/wrench/correction.h"
#include "files/machine_yaml.h"
#include "files/model_json.h"
#include "files/text/whole.h"
#include "firmware_host/config/load_model.h"
#include "tables/load.h"
#include "tools/digreport/run.h"
#include "tools/digreport/shift_page.h"

#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INTO(field) DIG_INTO(struct digreport_options, field)

static const struct dig_command commands[] = {
    { "shift", "LOG.lcm... [OPTION]...",
      "Shows what a shift was like, from the LCM logs of digsightd.",
      "Digs, gravel, peak and energy, error of the predictions, effects of the model, troubles. "
      "Logs in the order in which they were written. One sentence goes to standard output. With "
      "--table and --machine numbers are shown at rig scale, too.",
      "digreport shift --html shift.html --csv shift.csv early.lcm late.lcm\n"
      "digreport shift --html shift.html --table tables/product.sqlite \\\n"
      "          --machine config/machines/zx200_trench.yaml day.lcm\n" },
};

static enum dig_status take_truth(const char *const text, void *const into,
                                  struct dig_error *const error)
{
    struct digreport_options *const o   = into;
    struct dig_gravel               g   = { { 0.0 } };
    const char                     *at  = text;
    char                           *end = NULL;
    for (int a = 0; a < DIG_AXES; a++) {
        g.value[a] = strtod(at, &end);
        if (end == at || *end != (a + 1 < DIG_AXES ? ',' : '\0') || !isfinite(g.value[a])) {
            return dig_error_set(error, DIG_EINVAL, "--truth %s: expected FRICTION,ROLLING,DENSITY",
                                 text);
        }
        at = end + 1;
    }
    o->truth       = g;
    o->truth_known = true;
    return DIG_OK;
}

static enum dig_status take_recording(const char *const path, void *const into,
                                      struct dig_error *const error)
{
    struct digreport_options *const o = into;
    if (o->recordings == sizeof o->recording / sizeof o->recording[0]) {
        return dig_error_set(error, DIG_EINVAL, "--recording: expected at most 8");
    }
    o->recording[o->recordings++] = path;
    return DIG_OK;
}

static const struct dig_option known[] = {
    { "table", "TABLE.sqlite", NULL, "what the daemon predicted from", INTO(table) },
    { "machine", "MACHINE.yaml", NULL, "the machine that dug", INTO(machine) },
    { "model", "MODEL.json", NULL, "the model that the daemon ran with", INTO(model) },
    { "truth", "FRICTION,ROLLING,DENSITY", " digreport ", "the gravel, where it is known",
      .take = take_truth },
    { "recording", "RECORDING.csv", " digreport ",
      "a force recording that was fed to the rig, drawn beside; up to 8", .take = take_recording },
    { "title", "TEXT", NULL, "of the page", INTO(title) },
    { "html", "PAGE.html", NULL, "write a page with plots", INTO(html), .writes = true },
    { "csv", "DIGS.csv", " shift ", "write a line a dig", INTO(csv), .writes = true },
    { "json", "FILE.json", NULL,
      "write the results as JSON, - for standard output; what people read goes to standard error "
      "then",
      INTO(json), .writes = true },
    { "quiet", NULL, NULL, "nothing for people, only what goes wrong", INTO(quiet), .letter = 'q' },
};

static const struct dig_program program = {
    .self        = { "digreport",
                     "--table TABLE --machine MACHINE NAME=LOG.lcm... [OPTION]...\nshift ARGUMENT...",
                     "Shows what a run of digsightd identified and predicted, from its LCM log.",
                     "NAME is how the run is called in the report; up to 4 runs. A log must hold one "
                            "simple dig that identified the gravel and one later dig that was predicted.\n\n"
                            "The table of results goes to standard output.",
                     "digreport --table tables/product.sqlite --html report.html \\\n"
                            "          --machine config/machines/zx200_trench.yaml "
                            "\"SocketCAN=site.lcm\"\n" },
    .exit_status = "0  done\n1  the work failed, or a log holds no identified and predicted dig\n"
                   "2  bad usage or bad input\n",
    .alone       = true,
    .commands    = sizeof commands / sizeof commands[0],
    .command     = commands,
    .options     = sizeof known / sizeof known[0],
    .option      = known,
};

static enum dig_status check_shift(const struct digreport_options *const o,
                                   struct dig_error *const               error)
{
    if (o->logs == 0) {
        return dig_error_set(error, DIG_EINVAL, "shift: expected at least one LOG.lcm");
    }
    if ((o->table == NULL) != (o->machine == NULL)) {
        return dig_error_set(error, DIG_EINVAL,
                             "shift: expected --table and --machine, or neither: both tell how "
                             "much larger the machine is than the rig");
    }
    return DIG_OK;
}

static enum dig_status check_runs(const struct digreport_options *const o,
                                  struct dig_error *const               error)
{
    for (size_t i = 0; i < o->logs; i++) {
        if (i == DIG_REPORT_RUNS_MAX || strchr(o->log[i], '=') == NULL) {
            char             text[DIG_GUESS_SIZE];
            struct dig_guess guess = dig_guess(o->log[i]);
            dig_guess_try(&guess, commands[0].name);
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: expected NAME=LOG.lcm, at most %d of them%s", o->log[i],
                                 DIG_REPORT_RUNS_MAX, dig_guess_text(&guess, "", text));
        }
    }
    return o->table != NULL && o->machine != NULL && o->logs > 0
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "expected --table, --machine and at least one NAME=LOG.lcm");
}

static enum dig_status parse(const int argc, char *argv[], struct digreport_options *const o,
                             struct dig_error *const error)
{
    const struct dig_command *const command = dig_options_read(&program, argc, argv, o, error);
    if (command == NULL) {
        return DIG_EINVAL;
    }
    o->shift                     = command == &commands[0];
    o->log                       = argv + optind;
    o->logs                      = (size_t)(argc - optind);
    const enum dig_status status = o->shift ? check_shift(o, error) : check_runs(o, error);
    return status == DIG_OK && dig_out_is_stdout(o->html) + dig_out_is_stdout(o->csv) +
                                       dig_out_is_stdout(o->json) >
                                   1
               ? dig_error_set(error, DIG_EINVAL, "%stwo results on standard output, expected one",
                               o->shift ? "shift: " : "")
               : status;
}

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
    if (parse(argc, argv, &options, &error) != DIG_OK) {
        dig_options_refuse(&program, argv[1], error.text, stderr);
        return 2;
    }
    struct loaded   had    = { .set = NULL };
    enum dig_status status = load(&options, &had, &error);
    if (status == DIG_OK) {
        status = options.shift ? report_shift(&options, &had, &error)
                               : report_runs(&options, &had, &error);
    }
    dig_curve_set_destroy(had.set);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digreport: %s\n", error.text);
    }
    return dig_streams_end("digreport", status == DIG_OK ? EXIT_SUCCESS
                                        : (status == DIG_EINVAL || status == DIG_ESCHEMA)
                                            ? 2
                                            : EXIT_FAILURE);
}
