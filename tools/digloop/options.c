#include "tools/digloop/commands.h"

#include "core/did_you_mean.h"
#include "core/help.h"
#include "core/units.h"
#include "files/text/whole.h"
#include "tools/digloop/help.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Results that would go to standard output, one into the other.
static int results_on_stdout(const struct digloop_options *const o)
{
    return (int)dig_out_is_stdout(o->out) + (int)dig_out_is_stdout(o->html) +
           (int)dig_out_is_stdout(o->add) +
           (o->json_out != NULL ? (int)dig_out_is_stdout(o->json_out) : (int)o->json);
}

static enum dig_status check(const struct digloop_options *const o, struct dig_error *const error)
{
    if (results_on_stdout(o) > 1) {
        return dig_error_set(error, DIG_EINVAL, "two results on standard output, expected one");
    }
    static const struct {
        const char *command;
        int         least, most; // recordings
        const char *expected;
    } of[] = {
        { "identify", 1, DIGLOOP_RECORDINGS_MAX, "TABLE.sqlite and 1 to 64 RECORDING" },
        { "predict", 0, 0, "TABLE.sqlite --identified ID.json --trajectory NAME" },
        { "trace", 1, 1, "TABLE.sqlite CAMPAIGN/" },
        { "check", 1, 1, "MACHINE.yaml RECORDING" },
        { "design", 0, 0, "TABLE.sqlite" },
    };
    _Static_assert(DIGLOOP_RECORDINGS_MAX == 64, "the text says it");
    size_t i = 0;
    while (strcmp(o->command, of[i].command) != 0) {
        i++;
    }
    const bool named =
        strcmp(o->command, "predict") != 0 || (o->identified != NULL && o->trajectory != NULL);
    return named && o->recordings >= of[i].least && o->recordings <= of[i].most
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL, "%s: expected %s", o->command, of[i].expected);
}

// One option into *o.
static enum dig_status take(const int option, struct digloop_options *const o,
                            struct dig_error *const error)
{
    switch (option) {
    case DIGLOOP_IDENTIFIED: o->identified = optarg; break;
    case DIGLOOP_TRAJECTORY: o->trajectory = optarg; break;
    case DIGLOOP_MACHINE: o->machine = optarg; break;
    case DIGLOOP_MODEL: o->model = optarg; break;
    case DIGLOOP_MOMENT_ALONE: o->moment_alone = true; break;
    case DIGLOOP_OUTPUT: o->out = optarg; break;
    case DIGLOOP_MEASURED: o->measured = optarg; break;
    case DIGLOOP_DEPTH:
        if (!dig_number_read(optarg, DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST,
                             &o->approach.depth)) {
            return dig_error_set(error, DIG_EINVAL, "--depth %s: expected 0.2 to 3", optarg);
        }
        break;
    case DIGLOOP_ATTACK:
        if (!dig_number_read(optarg, -45.0, 45.0, &o->approach.attack_rad)) {
            return dig_error_set(error, DIG_EINVAL, "--attack-deg %s: expected -45 to 45", optarg);
        }
        o->approach.attack_rad *= DIG_RAD_PER_DEG;
        break;
    case DIGLOOP_EFFECTS: o->effects = optarg; break;
    case DIGLOOP_JSON:
        o->json     = true;
        o->json_out = optarg;
        break;
    case DIGLOOP_HTML: o->html = optarg; break;
    case DIGLOOP_ADD: o->add = optarg; break;
    case DIGLOOP_QUIET: o->quiet = true; break;
    default: return DIG_EINVAL; // said already
    }
    return DIG_OK;
}

enum dig_status digloop_parse(const int argc, char *argv[], struct digloop_options *const options,
                              struct dig_error *const error)
{
    const struct dig_command *const command = dig_command_find(digloop_program(), argv[1], error);
    if (command == NULL) {
        return DIG_EINVAL;
    }
    struct digloop_options o = { .command = command->name, .approach = dig_approach_plain() };
    for (int c;
         (c = dig_option_next(digloop_program(), command, argc, argv, error)) != DIG_OPTION_END;) {
        if (c == DIG_OPTION_HELP) {
            dig_help_print(digloop_program(), command, stdout);
            exit(EXIT_SUCCESS);
        }
        if (c == DIG_OPTION_VERSION) {
            (void)puts("digloop " DIG_VERSION);
            exit(EXIT_SUCCESS);
        }
        const enum dig_status status = take(c, &o, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (optind >= argc) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected %s", command->name, command->usage);
    }
    o.table                      = argv[optind];
    o.recording                  = argv + optind + 1;
    o.recordings                 = argc - optind - 1;
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
        char             text[DIG_GUESS_SIZE];
        struct dig_guess guess = dig_guess(options->trajectory);
        for (size_t t = 0; t < set->trajectories; t++) {
            dig_guess_try(&guess, set->trajectory[t].name);
        }
        return dig_error_set(error, DIG_EINVAL, "--trajectory %s: %s has no such trajectory%s",
                             options->trajectory, options->table, dig_guess_text(&guess, "", text));
    }
    *trajectory = found;
    return DIG_OK;
}
