#include "tools/digtable/arguments.h"

#include "core/units.h"

#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Every option of every command; which command takes which, it says itself.
enum option_id {
    OPTION_TRAJECTORY = 256,
    OPTION_FRICTION,
    OPTION_ROLLING,
    OPTION_DENSITY,
    OPTION_DEPTH,
    OPTION_ATTACK,
    OPTION_YOUNG,
    OPTION_SEED,
    OPTION_ENGINE,
    OPTION_BED,
    OPTION_SAVE_BED,
    OPTION_VTK,
    OPTION_MAP,
    OPTION_PACKINGS,
    OPTION_TIME_LIMIT,
    OPTION_SHARD,
    OPTION_CHANNEL,
    OPTION_CSV,
    OPTION_JSON,
    OPTION_RUNS,
    OPTION_EFFECTS,
    OPTION_COMPLETE,
};

static const struct option long_options[] = {
    { "trajectory", required_argument, NULL, OPTION_TRAJECTORY },
    { "friction", required_argument, NULL, OPTION_FRICTION },
    { "rolling", required_argument, NULL, OPTION_ROLLING },
    { "density", required_argument, NULL, OPTION_DENSITY },
    { "depth", required_argument, NULL, OPTION_DEPTH },
    { "attack-deg", required_argument, NULL, OPTION_ATTACK },
    { "young", required_argument, NULL, OPTION_YOUNG },
    { "seed", required_argument, NULL, OPTION_SEED },
    { "engine", required_argument, NULL, OPTION_ENGINE },
    { "bed", required_argument, NULL, OPTION_BED },
    { "save-bed", required_argument, NULL, OPTION_SAVE_BED },
    { "vtk", required_argument, NULL, OPTION_VTK },
    { "map", required_argument, NULL, OPTION_MAP },
    { "packings", required_argument, NULL, OPTION_PACKINGS },
    { "time-limit", required_argument, NULL, OPTION_TIME_LIMIT },
    { "shard", required_argument, NULL, OPTION_SHARD },
    { "channel", required_argument, NULL, OPTION_CHANNEL },
    { "csv", no_argument, NULL, OPTION_CSV },
    { "json", no_argument, NULL, OPTION_JSON },
    { "runs", no_argument, NULL, OPTION_RUNS },
    { "effects", no_argument, NULL, OPTION_EFFECTS },
    { "complete", no_argument, NULL, OPTION_COMPLETE },
    { "output", required_argument, NULL, 'o' },
    { "jobs", required_argument, NULL, 'j' },
    { NULL, 0, NULL, 0 },
};

__attribute__((format(printf, 1, 2))) int dig_cli_bad_usage(const char *const format, ...)
{
    va_list args;
    va_start(args, format);
    (void)fputs("digtable: ", stderr);
    (void)vfprintf(stderr, format, args);
    (void)fputs("\ndigtable: see digtable --help\n", stderr);
    va_end(args);
    return EXIT_BAD_INPUT;
}

int dig_cli_bad_input(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digtable: %s\n", error->text);
    return status == DIG_ENOMEM ? EXIT_WORK_FAILED : EXIT_BAD_INPUT;
}

int dig_cli_work_failed(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digtable: %s\n",
                  error->text[0] != '\0' ? error->text : dig_status_str(status));
    return status == DIG_EINVAL || status == DIG_ESCHEMA ? EXIT_BAD_INPUT : EXIT_WORK_FAILED;
}

static bool number(const char *const text, const double least, const double most,
                   double *const value)
{
    char        *end    = NULL;
    const double number = strtod(text, &end);
    if (end == text || *end != '\0' || !(number >= least && number <= most)) {
        return false;
    }
    *value = number;
    return true;
}

bool dig_cli_count(const char *const text, const unsigned long least, const unsigned long most,
                   unsigned long *const value)
{
    char               *end    = NULL;
    const unsigned long number = strtoul(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end != '\0' || number < least || number > most) {
        return false;
    }
    *value = number;
    return true;
}

static bool parse_channel(const char *const text, enum dig_channel *const channel)
{
    static const char *const names[DIG_CHANNELS] = { "My", "Fx", "Fz", "carried" };
    for (int c = 0; c < DIG_CHANNELS; c++) {
        if (strcmp(text, names[c]) == 0) {
            *channel = (enum dig_channel)c;
            return true;
        }
    }
    return false;
}

// "2/8": the second of eight.
static bool parse_shard(const char *const text, struct dig_arguments *const a)
{
    char              first[16];
    const char *const slash  = strchr(text, '/');
    const size_t      length = slash != NULL ? (size_t)(slash - text) : sizeof first;
    unsigned long     shard  = 0;
    unsigned long     shards = 0;
    if (length >= sizeof first) {
        return false;
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (!dig_cli_count(text + length + 1, 1, 1000000, &shards) ||
        !dig_cli_count(first, 1, shards, &shard)) {
        return false;
    }
    a->shard  = shard - 1;
    a->shards = shards;
    return true;
}

static unsigned long all_cores(void)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 0 ? (unsigned long)cores : 1;
}

static const char *take_approach(const int option, const char *const value,
                                 struct dig_approach *const approach)
{
    if (option == OPTION_DEPTH) {
        const bool ok =
            number(value, DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST, &approach->depth);
        return ok ? NULL : "a factor, 0.2 to 3";
    }
    const bool ok = number(value, -45.0, 45.0, &approach->attack_rad);
    approach->attack_rad *= DIG_RAD_PER_DEG;
    return ok ? NULL : "degrees, -45 to 45";
}

static bool take_engine(const char *const value, enum dig_engine_choice *const engine)
{
    static const char *const names[] = {
        [DIG_ENGINE_KERNEL] = "kernel",
        [DIG_ENGINE_ODE]    = "ode",
        [DIG_ENGINE_CUDA]   = "cuda",
    };
    for (size_t e = 0; e < sizeof names / sizeof names[0]; e++) {
        if (strcmp(value, names[e]) == 0) {
            *engine = (enum dig_engine_choice)e;
            return true;
        }
    }
    return false;
}

// One option into the arguments; NULL, or what was expected instead of its value.
static const char *take_option(const int option, const char *const value,
                               struct dig_arguments *const a)
{
    bool ok = true;
    switch (option) {
    case 'o': a->output = value; break;
    case 'j': ok = dig_cli_count(value, 1, 4096, &a->workers); return ok ? NULL : "1 to 4096";
    case OPTION_TRAJECTORY: a->trajectory = value; break;
    case OPTION_FRICTION:
        ok = number(value, 0.0, 3.0, &a->gravel[DIG_AXIS_FRICTION]);
        return ok ? NULL : "0 to 3";
    case OPTION_ROLLING:
        ok = number(value, 0.0, 3.0, &a->gravel[DIG_AXIS_ROLLING]);
        return ok ? NULL : "0 to 3";
    case OPTION_DENSITY:
        ok = number(value, 100.0, 20000.0, &a->gravel[DIG_AXIS_DENSITY_kgpm3]);
        return ok ? NULL : "kg/m3, 100 to 20000";
    case OPTION_DEPTH:
    case OPTION_ATTACK: return take_approach(option, value, &a->approach);
    case OPTION_YOUNG:
        ok = number(value, 1.0, 1e12, &a->young_Pa);
        return ok ? NULL : "Pa, 1 to 1e12";
    case OPTION_SEED:
        ok = dig_cli_count(value, 0, (unsigned long)INT64_MAX, &a->seed);
        return ok ? NULL : "a whole number below 2^63";
    case OPTION_ENGINE: return take_engine(value, &a->engine) ? NULL : "kernel, ode or cuda";
    case OPTION_BED: a->bed = value; break;
    case OPTION_SAVE_BED: a->save_bed = value; break;
    case OPTION_VTK: a->vtk = value; break;
    case OPTION_MAP: a->map = value; break;
    case OPTION_PACKINGS:
        ok = dig_cli_count(value, 1, 1000, &a->packings);
        return ok ? NULL : "1 to 1000";
    case OPTION_TIME_LIMIT:
        ok = number(value, 0.0, 1e9, &a->time_limit_s);
        return ok ? NULL : "seconds, >= 0";
    case OPTION_SHARD: return parse_shard(value, a) ? NULL : "I/N, I from 1 to N";
    case OPTION_CHANNEL:
        ok = parse_channel(value, &a->channel);
        return ok ? NULL : "My, Fx, Fz or carried";
    case OPTION_CSV: a->csv = true; break;
    case OPTION_JSON: a->json = true; break;
    case OPTION_RUNS: a->runs = true; break;
    case OPTION_EFFECTS: a->effects = true; break;
    case OPTION_COMPLETE: a->complete = true; break;
    default: break;
    }
    return NULL;
}

static const char *option_name(const int id)
{
    const struct option *o = long_options;
    while (o->name != NULL && o->val != id) {
        o++;
    }
    return o->name != NULL ? o->name : "?";
}

static bool takes(const struct dig_command *const command, const int option)
{
    char word[32];
    (void)snprintf(word, sizeof word, " %s ", option_name(option));
    return strstr(command->options, word) != NULL;
}

int dig_arguments_read(const struct dig_command *const command, const int argc, char **const argv,
                       struct dig_arguments *const a)
{
    *a = (struct dig_arguments){
        .gravel       = { (double)NAN, (double)NAN, (double)NAN },
        .approach     = dig_approach_plain(),
        .young_Pa     = (double)NAN,
        .seed         = 1,
        .workers      = all_cores(),
        .time_limit_s = (double)INFINITY,
    };
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, ":o:j:", long_options, NULL)) != -1;) {
        if (option == ':') {
            return dig_cli_bad_usage("%s: needs a value", argv[optind - 1]);
        }
        if (option == '?') {
            return dig_cli_bad_usage("%s: unknown option", argv[optind - 1]);
        }
        if (!takes(command, option)) {
            (void)fprintf(stderr, "digtable: %s takes no --%s\n", command->name,
                          option_name(option));
            return EXIT_BAD_INPUT;
        }
        const char *const expected = take_option(option, optarg, a);
        if (expected != NULL) {
            (void)fprintf(stderr, "digtable: --%s %s: expected %s\n", option_name(option), optarg,
                          expected);
            return EXIT_BAD_INPUT;
        }
    }
    for (; optind < argc; optind++) {
        if (a->positionals == command->most) {
            return dig_cli_bad_usage("%s: one argument too many", argv[optind]);
        }
        a->positional[a->positionals++] = argv[optind];
    }
    return a->positionals >= command->least ? EXIT_DONE
                                            : dig_cli_bad_usage("expected %s", command->positional);
}
