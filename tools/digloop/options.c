#include "tools/digloop/commands.h"

#include "core/units.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool has_trace_options(const struct digloop_options *const o)
{
    return o->effects != NULL || o->html != NULL || o->add != NULL;
}

static bool has_predict_options(const struct digloop_options *const o)
{
    return o->identified != NULL || o->measured != NULL || o->out != NULL ||
           !dig_approach_is_plain(&o->approach);
}

// What reads digs of its own takes.
static bool has_dig_options(const struct digloop_options *const o)
{
    return o->trajectory != NULL || o->machine != NULL || o->model != NULL;
}

static int to_stdout(const char *const path)
{
    return path != NULL && (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0) ? 1 : 0;
}

// Results that would go to standard output, one into the other.
static int results_on_stdout(const struct digloop_options *const o)
{
    return to_stdout(o->out) + to_stdout(o->html) + to_stdout(o->add) +
           (o->json_out != NULL ? to_stdout(o->json_out) : (int)o->json);
}

static enum dig_status check(const struct digloop_options *const o, struct dig_error *const error)
{
    if (results_on_stdout(o) > 1) {
        return dig_error_set(error, DIG_EINVAL, "two results on standard output, expected one");
    }
    if (o->moment_alone && strcmp(o->command, "identify") != 0) {
        return dig_error_set(error, DIG_EINVAL, "--moment-alone: expected with identify only");
    }
    if (strcmp(o->command, "identify") == 0) {
        return o->recordings >= 1 && o->recordings <= DIGLOOP_RECORDINGS_MAX &&
                       !has_predict_options(o) && !has_trace_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "identify: expected TABLE.sqlite and 1 to %d RECORDING",
                                   DIGLOOP_RECORDINGS_MAX);
    }
    if (strcmp(o->command, "predict") == 0) {
        return o->recordings == 0 && o->identified != NULL && o->trajectory != NULL &&
                       (o->machine == NULL || o->measured != NULL) && !has_trace_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "predict: expected TABLE.sqlite --identified ID.json "
                                   "--trajectory NAME, and --machine with --measured only");
    }
    if (strcmp(o->command, "trace") == 0) {
        return o->recordings == 1 && !has_predict_options(o) && !has_dig_options(o)
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL, "trace: expected TABLE.sqlite CAMPAIGN/");
    }
    if (strcmp(o->command, "design") == 0) {
        return o->recordings == 0 && !has_predict_options(o) && !has_dig_options(o) &&
                       o->html == NULL && o->add == NULL
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL, "design: expected TABLE.sqlite");
    }
    return dig_error_set(error, DIG_EINVAL, "%s: expected identify, predict, trace or design",
                         o->command);
}

static bool number(const char *const text, const double least, const double most,
                   double *const value)
{
    char        *end   = NULL;
    const double found = strtod(text, &end);
    if (end == text || *end != '\0' || !(found >= least && found <= most)) {
        return false;
    }
    *value = found;
    return true;
}

// trace takes a file after --json, the other commands write to standard output.
static bool is_trace(const int argc, char *argv[])
{
    return argc > 1 && strcmp(argv[1], "trace") == 0;
}

enum dig_status digloop_parse(const int argc, char *argv[], struct digloop_options *const options,
                              struct dig_error *const error)
{
    enum {
        IDENTIFIED = 256,
        TRAJECTORY,
        MACHINE,
        MODEL,
        MOMENT_ALONE,
        MEASURED,
        DEPTH,
        ATTACK,
        EFFECTS,
        JSON,
        HTML,
        ADD,
        HELP,
        VERSION
    };
    const struct option known[] = {
        { "identified", required_argument, NULL, IDENTIFIED },
        { "trajectory", required_argument, NULL, TRAJECTORY },
        { "machine", required_argument, NULL, MACHINE },
        { "model", required_argument, NULL, MODEL },
        { "moment-alone", no_argument, NULL, MOMENT_ALONE },
        { "measured", required_argument, NULL, MEASURED },
        { "depth", required_argument, NULL, DEPTH },
        { "attack-deg", required_argument, NULL, ATTACK },
        { "effects", required_argument, NULL, EFFECTS },
        { "json", is_trace(argc, argv) ? required_argument : no_argument, NULL, JSON },
        { "html", required_argument, NULL, HTML },
        { "add", required_argument, NULL, ADD },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct digloop_options o       = { .approach = dig_approach_plain() };
    const char *const      command = argc > 1 ? argv[1] : "";
    if (command[0] != '\0' && command[0] != '-' && !digloop_is_command(command)) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected identify, predict, trace or design",
                             command);
    }
    opterr = 0;
    for (int c; (c = getopt_long(argc, argv, "o:", known, NULL)) != -1;) {
        switch (c) {
        case IDENTIFIED: o.identified = optarg; break;
        case TRAJECTORY: o.trajectory = optarg; break;
        case MACHINE: o.machine = optarg; break;
        case MODEL: o.model = optarg; break;
        case MOMENT_ALONE: o.moment_alone = true; break;
        case 'o': o.out = optarg; break;
        case MEASURED: o.measured = optarg; break;
        case DEPTH:
            if (!number(optarg, DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST,
                        &o.approach.depth)) {
                return dig_error_set(error, DIG_EINVAL, "--depth %s: expected 0.2 to 3", optarg);
            }
            break;
        case ATTACK:
            if (!number(optarg, -45.0, 45.0, &o.approach.attack_rad)) {
                return dig_error_set(error, DIG_EINVAL, "--attack-deg %s: expected -45 to 45",
                                     optarg);
            }
            o.approach.attack_rad *= DIG_RAD_PER_DEG;
            break;
        case EFFECTS: o.effects = optarg; break;
        case JSON:
            o.json     = true;
            o.json_out = optarg;
            break;
        case HTML: o.html = optarg; break;
        case ADD: o.add = optarg; break;
        case HELP: digloop_help(command); exit(EXIT_SUCCESS);
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

enum dig_status digloop_input(const enum dig_status status)
{
    return status == DIG_EIO ? DIG_EINVAL : status;
}

enum dig_status digloop_find_trajectory(const struct digloop_options *const options,
                                        const struct dig_curve_set *const   set,
                                        int *const trajectory, struct dig_error *const error)
{
    const int found = dig_curve_set_find(set, options->trajectory);
    if (found < 0) {
        return dig_error_set(error, DIG_EINVAL, "--trajectory %s: %s has no such trajectory",
                             options->trajectory, options->table);
    }
    *trajectory = found;
    return DIG_OK;
}
