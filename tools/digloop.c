// digloop: which gravel resists like these recordings, what that gravel will resist with, and what
// the table lacks.

#include "core/command_line.h"
#include "core/streams.h"
#include "core/table_step.h"
#include "core/text.h"
#include "core/units.h"
#include "files/text/whole.h"
#include "tables/load.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INTO(field) DIG_INTO(struct digloop_options, field)

static const struct dig_command commands[] = {
    { "identify", "TABLE.sqlite RECORDING... [OPTION]...",
      "Finds the gravel that resists like recorded digs.",
      "All digs are matched together, by moment and forces where every dig has them, else by the "
      "moment alone. They must be along one trajectory, or along several that begin with "
      "\"simple\".\n\n"
      "A recording is a force recording, or with --machine a machine recording or an LCM log of "
      "the daemon, which may hold several digs.",
      "digloop identify tables/product.sqlite simple1.csv simple2.csv --json >id.json\n"
      "digloop identify tables/product.sqlite run.csv \\\n"
      "        --machine config/machines/zx200_trench.yaml\n"
      "digloop identify tables/product.sqlite day.lcm --trajectory simpleA \\\n"
      "        --machine config/machines/zx200_trench.yaml --json >id.json\n" },
    { "predict", "TABLE --identified ID.json --trajectory NAME [OPTION]...",
      "Predicts what an identified gravel resists other digs with.",
      "The prediction is at the table's scale, with --machine at that machine's, too: forces are "
      "lambda^3, moments lambda^4 times the table's, lambda being its bucket's length over the "
      "table's. Another depth or attack is predicted where the table has digs of such. --measured "
      "also prints the error, the relative Euclidean norm of the moment smoothed over +-0.16 s; "
      "each dig is compared as it was dug.",
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --machine config/machines/zx200_trench.yaml\n"
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --measured actual_1.csv\n"
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --measured day.lcm \\\n"
      "        --machine config/machines/zx200_trench.yaml\n" },
    { "trace", "TABLE.sqlite CAMPAIGN/ [OPTION]...", "Traces what the table lacks to an effect.",
      "Prints the residual of a campaign's digs, the effect it traces to, and the error on the "
      "holdout digs before and after that effect is added. Effects of the soil are compared with "
      "beds that hold them.\n\n"
      "A file \"-\" is standard output. What people are told goes there without --json and --add, "
      "else to standard error.",
      "digloop trace tables/product.sqlite campaign/\n"
      "digloop trace tables/product.sqlite campaign/ --html trace.html \\\n"
      "        --json trace.json --add model.json\n" },
    { "check", "MACHINE.yaml RECORDING [OPTION]...",
      "Says what a machine file makes of a recording in free air.",
      "A checklist: sample times, stuck sensors, how far each joint moves, which way and from "
      "where angles count, which cylinder is which, head and rod, units, offsets, weights, delay, "
      "and what none of that explains. Each answer with its 1 sigma, what is allowed, and what to "
      "do.\n\n"
      "RECORDING is a machine recording or an LCM log of the daemon, in which the bucket touches "
      "nothing: move boom, arm and bucket one after the other through most of their range, slowly, "
      "for about a minute. `digrig air` makes one of a simulated machine.\n\n"
      "A file \"-\" is standard output. The exit status is 2 where something is wrong.",
      "digloop check config/machines/zx120.yaml air.csv\n"
      "digloop check my.yaml air.lcm --html check.html --json check.json\n" },
    { "design", "TABLE.sqlite [OPTION]...",
      "Tells which simple dig of the table tells most about the gravel.",
      "Digs simulated with the table's own scatter confirm it, or not.",
      "digloop design tables/product.sqlite\n" },
};

static const struct dig_option known[] = {
    { "identified", "ID.json", " predict ", "the gravel, as `digloop identify --json` wrote it",
      INTO(identified) },
    { "trajectory", "NAME", " identify ", "take the digs along one only", INTO(trajectory) },
    { "trajectory", "NAME", " predict ", "the dig to predict", INTO(trajectory) },
    { "machine", "MACHINE.yaml", " identify ", "the recordings are of this machine",
      INTO(machine) },
    { "machine", "MACHINE.yaml", " predict ",
      "the measured digs are of this machine; peak and energy by it, too", INTO(machine) },
    { "model", "MODEL.json", " identify predict ",
      "table and machine with the effects that a trace has added", INTO(model) },
    { "moment-alone", NULL, " identify ", "leave the forces out", INTO(moment_alone) },
    { "measured", "RECORDING", " predict ", "compare with the digs measured in it",
      INTO(measured) },
    { "depth", "F", " predict ",
      "factor on how far the tooth goes down in the first phase, 0.2 to 3 (default 1)",
      INTO(approach.depth), DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST },
    { "attack-deg", "A", " predict ",
      "the bucket turned about its tooth, -45 to 45, positive curls (default 0)",
      INTO(approach.attack_rad), -45.0, 45.0, "deg" },
    { "output", "CURVE.csv", " predict ", "also write the predicted curve", INTO(out),
      .letter = 'o', .writes = true },
    { "effects", "EFFECTS.sqlite", " trace ",
      "beds that hold effects of the soil (default: TABLE_effects.sqlite beside the table)",
      INTO(effects) },
    { "json", NULL, " identify predict design ", "the result as JSON on standard output",
      INTO(json) },
    { "json", "OUT.json", " trace check ", "write the result as JSON", INTO(json_out),
      .writes = true },
    { "html", "OUT.html", " trace check ", "write it as a page with plots", INTO(html),
      .writes = true },
    { "add", "MODEL.json", " trace ",
      "write the model with the effect added, for digsightd and --model", INTO(add),
      .writes = true },
    { "quiet", NULL, " trace check ", "nothing for people, only what goes wrong", INTO(quiet),
      .letter = 'q' },
};

static const struct dig_program program = {
    .self        = { "digloop",
                     "COMMAND TABLE.sqlite ARGUMENT... [OPTION]...\ncheck MACHINE.yaml RECORDING "
                            "[OPTION]...\nCOMMAND --help",
                     "Finds the gravel of a table that resists like recorded digs, predicts other "
                            "digs, and traces what a model lacks.",
                     NULL,
                     "digloop identify tables/product.sqlite simpleA_1.csv --json >id.json\n"
                            "digloop predict tables/product.sqlite --identified id.json --trajectory "
                            "actual\n" },
    .exit_status = "0  done\n1  the work failed\n2  bad usage or bad input, or a check that "
                   "finds something wrong\n",
    .commands    = sizeof commands / sizeof commands[0],
    .command     = commands,
    .options     = sizeof known / sizeof known[0],
    .option      = known,
};

// How each command works, in the order above, and how many recordings it takes.
static const struct work {
    enum dig_status (*run)(const struct digloop_job *job, struct dig_error *error);
    int least, most;
} works[] = {
    { digloop_identify, 1, INT_MAX }, { digloop_predict, 0, 0 },
    { digloop_trace, 1, 1 },          { NULL, 1, 1 }, // check, which goes by no table
    { digloop_design, 0, 0 },
};

// Results that would go to standard output, one into the other.
static int results_on_stdout(const struct digloop_options *const o)
{
    return (int)dig_out_is_stdout(o->out) + (int)dig_out_is_stdout(o->html) +
           (int)dig_out_is_stdout(o->add) + (int)dig_out_is_stdout(o->json_out) + (int)o->json;
}

static enum dig_status check(const struct work *const work, const struct dig_command *const command,
                             const struct digloop_options *const o, struct dig_error *const error)
{
    if (results_on_stdout(o) > 1) {
        return dig_error_set(error, DIG_EINVAL, "two results on standard output, expected one");
    }
    if (o->recordings > work->most) {
        return dig_error_set(error, DIG_EINVAL, "%s: one argument too many",
                             o->recording[work->most]);
    }
    const bool named =
        work->run != digloop_predict || (o->identified != NULL && o->trajectory != NULL);
    return named && o->recordings >= work->least
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL, "%s: expected %s", command->name, command->usage);
}

// Reads the command line; NULL, with *error, where it is wrong.
static const struct work *parse(const int argc, char *argv[], struct digloop_options *const o,
                                struct dig_error *const error)
{
    const struct dig_command *const command = dig_options_read(&program, argc, argv, o, error);
    if (command == NULL) {
        return NULL;
    }
    if (optind >= argc) {
        (void)dig_error_set(error, DIG_EINVAL, "%s: expected %s", command->name, command->usage);
        return NULL;
    }
    o->approach.attack_rad *= DIG_RAD_PER_DEG; // degrees until here
    o->table                      = argv[optind];
    o->recording                  = argv + optind + 1;
    o->recordings                 = argc - optind - 1;
    const struct work *const work = &works[command - commands];
    return check(work, command, o, error) == DIG_OK ? work : NULL;
}

static enum dig_status run(const struct work *const            work,
                           const struct digloop_options *const options,
                           struct dig_curve_set *const set, struct dig_error *const error)
{
    struct digloop_machine machine;
    struct digloop_job     job    = { .options = options, .set = set };
    const enum dig_status  status = digloop_load_machine(&job, &machine, error);
    if (status != DIG_OK) {
        return status;
    }
    job.machine = options->machine != NULL ? &machine : NULL;
    return work->run(&job, error);
}

// Once for every command: all of them go by the table's curves.
static void note_step(const char *const table, const struct dig_curve_set *const set)
{
    char text[DIG_TABLE_STEP_TEXT_SIZE];
    dig_table_step_text(&set->step, text);
    if (text[0] != '\0') {
        dig_text_print(stderr, "digloop: %s: %s\n", table, text);
    }
}

// Of two frictions the table knows no bend between them, which a trace may take for an effect.
static void note_few_frictions(const char *const table, const struct dig_curve_set *const set)
{
    if (set->axis_count[DIG_AXIS_FRICTION] == 2) {
        dig_text_print(
            stderr,
            "digloop: %s: gravel between its two frictions is guessed, and may be taken "
            "for an effect; three or more are needed (docs/tables.md, \"How many digs\")\n",
            table);
    }
}

int main(const int argc, char *argv[])
{
    struct digloop_options options = { .approach = dig_approach_plain() };
    struct dig_error       error   = { "" };
    dig_streams_begin();
    const struct work *const work = parse(argc, argv, &options, &error);
    if (work == NULL) {
        dig_options_refuse(&program, argv[1], error.text, stderr);
        return 2;
    }
    const bool            checks = work->run == NULL;
    struct dig_curve_set *set    = NULL;
    bool                  wrong  = false;
    enum dig_status       status =
        dig_status_of_input(checks ? digloop_check(&options, &wrong, &error)
                                   : dig_table_load(options.table, &set, &error));
    if (status == DIG_OK && !checks) {
        note_step(options.table, set);
        if (work->run == digloop_trace) {
            note_few_frictions(options.table, set);
        }
        status = run(work, &options, set, &error);
    }
    dig_curve_set_destroy(set);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digloop: %s\n", error.text);
    }
    const bool input = status == DIG_EINVAL || status == DIG_ESCHEMA || status == DIG_ENOMATCH;
    return dig_streams_end("digloop", status == DIG_OK && !wrong ? EXIT_SUCCESS
                                      : input || wrong           ? 2
                                                                 : EXIT_FAILURE);
}
