#include "tools/digtable/arguments.h"

#include "core/did_you_mean.h"
#include "core/help.h"
#include "core/text.h"
#include "core/units.h"
#include "files/job_plan.h"
#include "offline_dem/device/engine_cuda.h"
#include "offline_dem/reference/engine_ode.h"
#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/help.h"

#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

__attribute__((format(printf, 1, 2))) int dig_cli_bad_usage(const char *const format, ...)
{
    char    text[4096];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    dig_text_print(stderr, "digtable: %s\ndigtable: see digtable --help\n", text);
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
        const bool ok = dig_number_read(value, DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST,
                                        &approach->depth);
        return ok ? NULL : "a factor, 0.2 to 3";
    }
    const bool ok = dig_number_read(value, -45.0, 45.0, &approach->attack_rad);
    approach->attack_rad *= DIG_RAD_PER_DEG;
    return ok ? NULL : "degrees, -45 to 45";
}

static bool take_engine(const char *const value, struct dig_arguments *const a)
{
    static const struct {
        const char *name;
        struct dig_engine (*make)(void);
        bool has_threads;
    } engines[] = {
        { "single", dig_engine_single, true },
        { "kernel", dig_engine_kernel, false },
        { "ode", dig_engine_ode, false },
        { "cuda", dig_engine_cuda, true },
    };
    for (size_t e = 0; e < sizeof engines / sizeof engines[0]; e++) {
        if (strcmp(value, engines[e].name) == 0) {
            a->engine      = engines[e].make;
            a->has_threads = engines[e].has_threads;
            return true;
        }
    }
    return false;
}

struct dig_engine dig_cli_engine(const struct dig_arguments *const a)
{
    struct dig_engine engine = a->engine();
    engine.stepper.threads   = a->threads;
    return engine;
}

// --time 1:00:00 is two words for sbatch, --sbatch-arg one.
static const char *take_submit_option(const int option, const char *const value,
                                      struct dig_arguments *const a)
{
    if (option == OPTION_TASKS) {
        return dig_cli_count(value, 1, DIG_JOB_TASKS_MAX, &a->tasks) ? NULL : "1 to 10000";
    }
    if (option == OPTION_SLURM) {
        a->slurm = true;
        return NULL;
    }
    if (a->slurm_options + 2 > DIG_SLURM_OPTIONS_MAX) {
        return "fewer words for sbatch";
    }
    if (option != OPTION_SBATCH_ARG) {
        a->slurm_option[a->slurm_options++] = option == OPTION_TIME ? "--time" : "--partition";
    }
    a->slurm_option[a->slurm_options++] = value;
    return NULL;
}

// One option into the arguments; NULL, or what was expected instead of its value.
static const char *take_option(const int option, const char *const value,
                               struct dig_arguments *const a)
{
    switch (option) {
    case OPTION_OUTPUT: a->output = value; break;
    case OPTION_QUIET: a->quiet = true; break;
    case OPTION_JOBS: return dig_cli_count(value, 1, 4096, &a->workers) ? NULL : "1 to 4096";
    case OPTION_THREADS: return dig_cli_count(value, 1, 256, &a->threads) ? NULL : "1 to 256";
    case OPTION_TRAJECTORY: a->trajectory = value; break;
    case OPTION_FRICTION:
        return dig_number_read(value, 0.0, 3.0, &a->gravel[DIG_AXIS_FRICTION]) ? NULL : "0 to 3";
    case OPTION_ROLLING:
        return dig_number_read(value, 0.0, 3.0, &a->gravel[DIG_AXIS_ROLLING]) ? NULL : "0 to 3";
    case OPTION_DENSITY:
        return dig_number_read(value, 100.0, 20000.0, &a->gravel[DIG_AXIS_DENSITY_kgpm3])
                   ? NULL
                   : "kg/m3, 100 to 20000";
    case OPTION_DEPTH:
    case OPTION_ATTACK: return take_approach(option, value, &a->approach);
    case OPTION_YOUNG:
        return dig_number_read(value, 1.0, 1e12, &a->young_Pa) ? NULL : "Pa, 1 to 1e12";
    case OPTION_SEED:
        return dig_cli_count(value, 0, (unsigned long)INT64_MAX, &a->seed)
                   ? NULL
                   : "a whole number below 2^63";
    case OPTION_ENGINE: return take_engine(value, a) ? NULL : "single, kernel, ode or cuda";
    case OPTION_BED: a->bed = value; break;
    case OPTION_SAVE_BED: a->save_bed = value; break;
    case OPTION_VTK: a->vtk = value; break;
    case OPTION_MAP: a->map = value; break;
    case OPTION_PACKINGS: return dig_cli_count(value, 1, 1000, &a->packings) ? NULL : "1 to 1000";
    case OPTION_TIME_LIMIT:
        return dig_number_read(value, 0.0, 1e9, &a->time_limit_s) ? NULL : "seconds, >= 0";
    case OPTION_SHARD: return parse_shard(value, a) ? NULL : "I/N, I from 1 to N";
    case OPTION_TASKS:
    case OPTION_SLURM:
    case OPTION_TIME:
    case OPTION_PARTITION:
    case OPTION_SBATCH_ARG: return take_submit_option(option, value, a);
    case OPTION_CHANNEL: return parse_channel(value, &a->channel) ? NULL : "My, Fx, Fz or carried";
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
    const struct dig_program *const program = dig_cli_program();
    size_t                          i       = 0;
    while (program->option[i].id != id) {
        i++;
    }
    return program->option[i].name;
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
        .engine       = dig_engine_single,
        .has_threads  = true,
        .time_limit_s = (double)INFINITY,
    };
    struct dig_error error = { "" };
    for (int option; (option = dig_option_next(dig_cli_program(), command, argc, argv, &error)) !=
                     DIG_OPTION_END;) {
        if (option == DIG_OPTION_WRONG) {
            return dig_cli_bad_usage("%s", error.text);
        }
        if (option == DIG_OPTION_HELP) {
            dig_help_print(dig_cli_program(), command, stdout);
            exit(EXIT_DONE);
        }
        if (option == DIG_OPTION_VERSION) {
            (void)puts("digtable " DIG_VERSION);
            exit(EXIT_DONE);
        }
        const char *const expected = take_option(option, optarg, a);
        if (expected != NULL) {
            (void)dig_error_set(&error, DIG_EINVAL, "--%s %s: expected %s", option_name(option),
                                optarg, expected);
            return dig_cli_bad_input(DIG_EINVAL, &error);
        }
    }
    for (; optind < argc; optind++) {
        if (a->positionals == DIG_POSITIONALS_MAX) {
            return dig_cli_bad_usage("%s: one argument too many", argv[optind]);
        }
        a->positional[a->positionals++] = argv[optind];
    }
    if (a->threads > 0 && !a->has_threads) {
        return dig_cli_bad_usage("--threads: only --engine single and cuda have them");
    }
    if (a->threads == 0 && a->has_threads) {
        a->threads = strcmp(command->name, "dig") == 0 ? all_cores() : 1;
    }
    return EXIT_DONE;
}
