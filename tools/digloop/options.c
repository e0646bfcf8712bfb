#include "tools/digloop/commands.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "digloop finds the gravel of a table that resists like recorded digs, predicts other digs, and "
    "traces what a model lacks.\n"
    "\n"
    "usage:\n"
    "  digloop identify TABLE.sqlite RECORDING.csv… [--json]\n"
    "      which gravel: force recordings of one trajectory, pooled\n"
    "  digloop predict TABLE.sqlite --identified ID.json --trajectory NAME\n"
    "                  [-o CURVE.csv] [--measured RECORDING.csv] [--json]\n"
    "      what that gravel will resist along another trajectory, at the table's scale; with a\n"
    "      measured dig, how wrong that was: relative Euclidean norm of the moment, +-0.16 s\n"
    "  digloop trace TABLE.sqlite CAMPAIGN/ [--effects EFFECTS.sqlite]\n"
    "                [--json OUT.json] [--html OUT.html] [--add MODEL.json]\n"
    "      what the table lacks: the residual of a campaign's digs, the effect it traces to, the\n"
    "      error on the holdout digs before and after that effect is added. Effects of the soil "
    "are\n"
    "      compared with beds that hold them, by default those of TABLE_effects.sqlite. OUT or "
    "MODEL\n"
    "      \"-\": standard output\n"
    "  digloop design TABLE.sqlite [--effects EFFECTS.sqlite] [--json]\n"
    "      which simple dig of the table tells most about the gravel and tells effects apart, and\n"
    "      whether digs simulated with the table's own scatter bear that out\n"
    "  digloop --help | --version\n"
    "\n"
    "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n"
    "\n"
    "examples:\n"
    "  digloop identify tables/rig.sqlite simpleA_1.csv simpleA_2.csv --json >id.json\n"
    "  digloop predict tables/rig.sqlite --identified id.json --trajectory actual \\\n"
    "          --measured actual_1.csv\n"
    "  digloop trace tables/rig.sqlite campaign/ --json trace.json --html trace.html --add "
    "model.json\n";

static bool has_trace_options(const struct digloop_options *const o)
{
    return o->effects != NULL || o->html != NULL || o->add != NULL;
}

static bool has_predict_options(const struct digloop_options *const o)
{
    return o->identified != NULL || o->trajectory != NULL || o->measured != NULL || o->out != NULL;
}

static enum dig_status check(const struct digloop_options *const o, struct dig_error *const error)
{
    if (strcmp(o->command, "identify") == 0) {
        return o->recordings >= 1 && o->recordings <= DIGLOOP_RECORDINGS_MAX &&
                       !has_predict_options(o) && !has_trace_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "identify: expected TABLE.sqlite and 1 to %d RECORDING.csv",
                                   DIGLOOP_RECORDINGS_MAX);
    }
    if (strcmp(o->command, "predict") == 0) {
        return o->recordings == 0 && o->identified != NULL && o->trajectory != NULL &&
                       !has_trace_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "predict: expected TABLE.sqlite --identified ID.json "
                                   "--trajectory NAME");
    }
    if (strcmp(o->command, "trace") == 0) {
        return o->recordings == 1 && !has_predict_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL, "trace: expected TABLE.sqlite CAMPAIGN/");
    }
    if (strcmp(o->command, "design") == 0) {
        return o->recordings == 0 && !has_predict_options(o) && o->html == NULL && o->add == NULL
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL, "design: expected TABLE.sqlite");
    }
    return dig_error_set(error, DIG_EINVAL, "%s: expected identify, predict, trace or design",
                         o->command);
}

// trace takes a file after --json, the other commands write to standard output.
static bool is_trace(const int argc, char *argv[])
{
    return argc > 1 && strcmp(argv[1], "trace") == 0;
}

enum dig_status digloop_parse(const int argc, char *argv[], struct digloop_options *const options,
                              struct dig_error *const error)
{
    enum { IDENTIFIED = 256, TRAJECTORY, MEASURED, EFFECTS, JSON, HTML, ADD, HELP, VERSION };
    const struct option known[] = {
        { "identified", required_argument, NULL, IDENTIFIED },
        { "trajectory", required_argument, NULL, TRAJECTORY },
        { "measured", required_argument, NULL, MEASURED },
        { "effects", required_argument, NULL, EFFECTS },
        { "json", is_trace(argc, argv) ? required_argument : no_argument, NULL, JSON },
        { "html", required_argument, NULL, HTML },
        { "add", required_argument, NULL, ADD },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct digloop_options o = { 0 };
    opterr                   = 0;
    for (int c; (c = getopt_long(argc, argv, "o:", known, NULL)) != -1;) {
        switch (c) {
        case IDENTIFIED: o.identified = optarg; break;
        case TRAJECTORY: o.trajectory = optarg; break;
        case 'o': o.out = optarg; break;
        case MEASURED: o.measured = optarg; break;
        case EFFECTS: o.effects = optarg; break;
        case JSON:
            o.json     = true;
            o.json_out = optarg;
            break;
        case HTML: o.html = optarg; break;
        case ADD: o.add = optarg; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        case VERSION: (void)puts("digloop " DIG_VERSION); exit(EXIT_SUCCESS);
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
        }
    }
    if (argc - optind < 2) {
        return dig_error_set(error, DIG_EINVAL, "expected a command and a table");
    }
    o.command                    = argv[optind];
    o.table                      = argv[optind + 1];
    o.recording                  = argv + optind + 2;
    o.recordings                 = argc - optind - 2;
    const enum dig_status status = check(&o, error);
    if (status == DIG_OK) {
        *options = o;
    }
    return status;
}
