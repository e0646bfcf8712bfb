#include "tools/digreport/options.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "digreport shows what a run of digsightd identified and predicted, from its LCM log.\n"
    "\n"
    "usage:\n"
    "  digreport --table TABLE.sqlite --machine MACHINE.yaml\n"
    "            [--truth FRICTION,ROLLING,DENSITY] [--recording RECORDING.csv]…\n"
    "            [--title TEXT] [--html PAGE.html] [--json FILE.json] NAME=LOG.lcm…\n"
    "      NAME is how the run is called in the report (\"Modbus TCP=tcp.lcm\"); up to 4 runs.\n"
    "      The log must hold one simple dig that identified the gravel and one later dig that was\n"
    "      predicted. --recording: a force recording that was fed to the rig, drawn beside.\n"
    "  digreport shift …\n"
    "      what a whole shift was like, from its logs: digreport shift --help\n"
    "  digreport --help | --version\n"
    "\n"
    "The table of results goes to standard output, with --json to standard error. Exit codes: 0 "
    "done,\n"
    "1 the work failed or the log holds no identified and predicted dig, 2 bad usage or bad "
    "input.\n"
    "\n"
    "examples:\n"
    "  digreport --table tables/rig.sqlite --machine config/machines/zx200_trench.yaml \\\n"
    "            --html report.html \"SocketCAN=site.lcm\"\n";

static enum dig_status parse_truth(const char *const text, struct dig_gravel *const truth,
                                   struct dig_error *const error)
{
    struct dig_gravel g   = { { 0.0 } };
    const char       *at  = text;
    char             *end = NULL;
    for (int a = 0; a < DIG_AXES; a++) {
        g.value[a] = strtod(at, &end);
        if (end == at || *end != (a + 1 < DIG_AXES ? ',' : '\0') || !isfinite(g.value[a])) {
            return dig_error_set(error, DIG_EINVAL, "--truth %s: expected FRICTION,ROLLING,DENSITY",
                                 text);
        }
        at = end + 1;
    }
    *truth = g;
    return DIG_OK;
}

enum dig_status digreport_parse(const int argc, char *argv[],
                                struct digreport_options *const options,
                                struct dig_error *const         error)
{
    enum { TABLE = 256, MACHINE, TRUTH, RECORDING, TITLE, HTML, JSON, HELP, VERSION };
    static const struct option known[] = {
        { "table", required_argument, NULL, TABLE },
        { "machine", required_argument, NULL, MACHINE },
        { "truth", required_argument, NULL, TRUTH },
        { "recording", required_argument, NULL, RECORDING },
        { "title", required_argument, NULL, TITLE },
        { "html", required_argument, NULL, HTML },
        { "json", required_argument, NULL, JSON },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct digreport_options o = { .title = "What the ground resisted with" };
    opterr                     = 0;
    for (int c; (c = getopt_long(argc, argv, "", known, NULL)) != -1;) {
        switch (c) {
        case TABLE: o.table = optarg; break;
        case MACHINE: o.machine = optarg; break;
        case TITLE: o.title = optarg; break;
        case HTML: o.html = optarg; break;
        case JSON: o.json = optarg; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        case VERSION: (void)puts("digreport " DIG_VERSION); exit(EXIT_SUCCESS);
        case TRUTH: {
            const enum dig_status status = parse_truth(optarg, &o.truth, error);
            if (status != DIG_OK) {
                return status;
            }
            o.truth_known = true;
            break;
        }
        case RECORDING:
            if (o.recordings == sizeof o.recording / sizeof o.recording[0]) {
                return dig_error_set(error, DIG_EINVAL, "--recording: expected at most 8");
            }
            o.recording[o.recordings++] = optarg;
            break;
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
        }
    }
    for (; optind < argc; optind++) {
        if (o.logs == DIG_REPORT_RUNS_MAX || strchr(argv[optind], '=') == NULL) {
            return dig_error_set(error, DIG_EINVAL, "%s: expected NAME=LOG.lcm, at most %d of them",
                                 argv[optind], DIG_REPORT_RUNS_MAX);
        }
        o.log[o.logs++] = argv[optind];
    }
    if (o.table == NULL || o.machine == NULL || o.logs == 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "expected --table, --machine and at least one NAME=LOG.lcm");
    }
    *options = o;
    return DIG_OK;
}
