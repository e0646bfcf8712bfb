#include "tools/digreport/options.h"

#include "core/command_line.h"
#include "core/did_you_mean.h"
#include "files/text/whole.h"

#include <getopt.h>
#include <math.h>
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
    { "html", "PAGE.html", NULL, "write a page with plots", INTO(html) },
    { "csv", "DIGS.csv", " shift ", "write a line a dig", INTO(csv) },
    { "json", "FILE.json", NULL,
      "write the results as JSON, - for standard output; what people read goes to standard error "
      "then",
      INTO(json) },
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

enum dig_status digreport_parse(const int argc, char *argv[],
                                struct digreport_options *const options,
                                struct dig_error *const         error)
{
    struct digreport_options        o       = { .shift = false };
    const struct dig_command *const command = dig_options_read(&program, argc, argv, &o, error);
    if (command == NULL) {
        return DIG_EINVAL;
    }
    o.shift                      = command == &commands[0];
    o.log                        = argv + optind;
    o.logs                       = (size_t)(argc - optind);
    const enum dig_status status = o.shift ? check_shift(&o, error) : check_runs(&o, error);
    if (status != DIG_OK) {
        return status;
    }
    if (dig_out_is_stdout(o.html) + dig_out_is_stdout(o.csv) + dig_out_is_stdout(o.json) > 1) {
        return dig_error_set(error, DIG_EINVAL, "%stwo results on standard output, expected one",
                             o.shift ? "shift: " : "");
    }
    *options = o;
    return DIG_OK;
}

int digreport_refuse(const char *const word, const struct dig_error *const error)
{
    dig_options_refuse(&program, word, error->text, stderr);
    return 2;
}
