#include "tools/digtable/arguments.h"

#include "core/text.h"
#include "core/units.h"
#include "files/job_plan.h"
#include "offline_dem/device/engine_cuda.h"
#include "offline_dem/reference/engine_ode.h"
#include "offline_dem/sweep/sweep.h"

#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

static enum dig_status take_channel(const char *const text, void *const into,
                                    struct dig_error *const error)
{
    static const char *const names[DIG_CHANNELS] = { "My", "Fx", "Fz", "carried" };
    for (int c = 0; c < DIG_CHANNELS; c++) {
        if (strcmp(text, names[c]) == 0) {
            ((struct dig_arguments *)into)->channel = (enum dig_channel)c;
            return DIG_OK;
        }
    }
    return dig_error_set(error, DIG_EINVAL, "--channel %s: expected My, Fx, Fz or carried", text);
}

// "2/8": the second of eight.
static enum dig_status take_shard(const char *const text, void *const into,
                                  struct dig_error *const error)
{
    struct dig_arguments *const a = into;
    char                        first[16];
    uint64_t                    shard  = 0;
    uint64_t                    shards = 0;
    const char *const           slash  = strchr(text, '/');
    const bool                  short_enough =
        slash != NULL &&
        snprintf(first, sizeof first, "%.*s", (int)(slash - text), text) < (int)sizeof first;
    if (!short_enough || !dig_count_read(slash + 1, 1, 1000000, &shards) ||
        !dig_count_read(first, 1, shards, &shard)) {
        return dig_error_set(error, DIG_EINVAL, "--shard %s: expected I/N, I from 1 to N", text);
    }
    a->shard  = shard - 1;
    a->shards = shards;
    return DIG_OK;
}

static uint64_t all_cores(void)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 0 ? (uint64_t)cores : 1;
}

static enum dig_status take_engine(const char *const value, void *const into,
                                   struct dig_error *const error)
{
    struct dig_arguments *const a = into;
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
            return DIG_OK;
        }
    }
    return dig_error_set(error, DIG_EINVAL, "--engine %s: expected single, kernel, ode or cuda",
                         value);
}

static enum dig_status take_sbatch_arg(const char *const value, void *const into,
                                       struct dig_error *const error)
{
    struct dig_arguments *const a = into;
    if (a->sbatch_args == DIG_SBATCH_ARGS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "--sbatch-arg %s: expected at most %d", value,
                             DIG_SBATCH_ARGS_MAX);
    }
    a->sbatch_arg[a->sbatch_args++] = value;
    return DIG_OK;
}

#define INTO(field) DIG_INTO(struct dig_arguments, field)

static const struct dig_command commands[] = {
    { "dig", "SCENE.yaml --trajectory NAME GRAVEL -o CSV [OPTION]...",
      "Computes one dig; the curve is a force recording.",
      "GRAVEL is --friction F --rolling R --density KGPM3.",
      "digtable dig config/scenes/product.yaml --trajectory simpleA --friction .5 \\\n"
      "         --rolling .5 --density 2500 -o dig.csv\n" },
    { "generate", "SCENE.yaml GRID.yaml -o TABLE.sqlite [OPTION]...",
      "Computes every dig of a grid, on all cores.",
      "What the table holds already is not computed again, and Ctrl-C keeps all that is finished.",
      "digtable generate config/scenes/product.yaml config/grids/product.yaml \\\n"
      "         -o my.sqlite --time-limit 3600\n"
      "digtable generate config/scenes/product.yaml config/grids/product.yaml \\\n"
      "         -o part3.sqlite --shard 3/16\n" },
    { "submit", "SCENE.yaml GRID.yaml -o TABLE.sqlite [OPTION]...",
      "Has Slurm compute a table in shards, as a job array.",
      "Plans once, in the folder TABLE.sqlite.jobs, and merges the shards when all are done. The "
      "same command again submits what failed, and only that.",
      "digtable submit scene.yaml grid.yaml -o my.sqlite --tasks 500 --time 4:00:00\n" },
    { "status", "TABLE.sqlite [OPTION]...", "Shows how far a table of `digtable submit` is.", NULL,
      "digtable status my.sqlite --json\n" },
    { "list", "TABLE.sqlite [OPTION]...", "Lists the entries and how many packings each has.", NULL,
      "digtable list tables/product.sqlite\n" },
    { "show",
      "TABLE.sqlite ENTRY [OPTION]...\n"
      "TABLE.sqlite GRAVEL [OPTION]...",
      "Shows one curve of a table.",
      "ENTRY is a number of `digtable list`, GRAVEL is --friction F --rolling R --density KGPM3. "
      "The curve is drawn in the terminal, unless --csv or --json asks for its numbers.",
      "digtable show tables/product.sqlite --friction .5 --rolling .5 \\\n"
      "         --density 2500 --trajectory actual\n"
      "digtable show tables/product.sqlite 0 --channel Fx\n"
      "digtable show tables/product.sqlite 0 --csv >curve.csv\n" },
    { "import", "CURVES.csv --map MAP.yaml -o TABLE.sqlite [OPTION]...",
      "Adds digs that something else measured or computed to a table.",
      "The map says which column holds what.",
      "digtable import curves.csv --map curve_map.yaml -o measured.sqlite\n" },
    { "merge", "OUT.sqlite IN...", "Puts the runs of all tables, each once, into a new one.",
      "IN is a table, or a folder of them. The bytes of the new table do not depend on their "
      "order.",
      "digtable merge my.sqlite part*.sqlite\n"
      "digtable merge my.sqlite my.sqlite.jobs/shards\n" },
    { "export", "TABLE.sqlite [OPTION]...", "Writes all curves of a table as CSV.", NULL,
      "digtable export tables/product.sqlite -o curves.csv\n"
      "digtable export tables/product_effects.sqlite --effects >effects.csv\n"
      "digtable export my.sqlite --runs -o runs.csv\n" },
    { "check", "TABLE.sqlite [OPTION]...",
      "Checks version, integrity, and every curve against the runs it was made of.", NULL,
      "digtable check tables/product.sqlite\n"
      "digtable check my.sqlite --complete --json\n" },
};

static const struct dig_option options[] = {
    { "trajectory", "NAME", " dig ", "its name in the scene", INTO(trajectory) },
    { "trajectory", "NAME", " show ", "its name in the scene (default: the entry's first)",
      INTO(trajectory) },
    { "friction", "F", " dig show ", "friction of the gravel, 0 to 3",
      INTO(gravel[DIG_AXIS_FRICTION]), 0.0, 3.0 },
    { "rolling", "R", " dig show ", "rolling friction of the gravel, 0 to 3",
      INTO(gravel[DIG_AXIS_ROLLING]), 0.0, 3.0 },
    { "density", "KGPM3", " dig show ", "density of the grains in kg/m3, 100 to 20000",
      INTO(gravel[DIG_AXIS_DENSITY_kgpm3]), 100.0, 20000.0, "kg/m3" },
    { "depth", "F", " dig show ",
      "factor on how far the tooth goes down in the first phase, 0.2 to 3 (default 1)",
      INTO(approach.depth), DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST },
    { "attack-deg", "A", " dig show ",
      "the bucket turned about its tooth, -45 to 45, positive curls (default 0)",
      INTO(approach.attack_rad), -45.0, 45.0, "deg" },
    { "young", "PA", " dig ", "Young's modulus (default: the scene's)", INTO(young_Pa), 1.0, 1e12,
      "Pa" },
    { "seed", "N", " dig ", "of the bed (default 1)", INTO(seed) },
    { "engine", "single|kernel|ode|cuda", " dig generate submit ",
      "single (default): plain gravel in single precision; kernel, in double; ode, the slow "
      "reference; cuda, on a graphics card, with the library of `make cuda`",
      .take = take_engine },
    { "bed", "BED.csv", " dig ", "dig this bed instead of pouring one", INTO(bed) },
    { "save-bed", "BED.csv", " dig ", "write the bed before it is dug", INTO(save_bed),
      .writes = true },
    { "vtk", "DIR", " dig ", "write grains and bucket for ParaView into DIR", INTO(vtk) },
    { "output", "CURVE.csv", " dig ", "the curve to write; -: standard output", INTO(output),
      .letter = 'o', .writes = true },
    { "output", "TABLE.sqlite", " generate import submit ", "the table to make or to go on with",
      INTO(output), .letter = 'o' },
    { "output", "FILE.csv", " export ", "the file to write (default: standard output)",
      INTO(output), .letter = 'o', .writes = true },
    { "jobs", "N", " generate ", "digs at a time (default: one a core)", INTO(workers), 1, 4096,
      .letter = 'j' },
    { "threads", "N", " dig ",
      "of engines single and cuda in a bed of more than 30000 grains (default: one a core)",
      INTO(threads), 1, 256 },
    { "threads", "N", " generate ",
      "of engines single and cuda in a bed of more than 30000 grains (default 1)", INTO(threads), 1,
      256 },
    { "packings", "N", " generate submit ", "beds of each gravel (default: the grid's number)",
      INTO(packings), 1, 1000 },
    { "time-limit", "S", " generate ", "begin no dig after S seconds (default: no limit)",
      INTO(time_limit_s), 0.0, 1e9, "s" },
    { "shard", "I/N", " generate ",
      "the I-th of N parts alone; `digtable merge` puts the parts together", .take = take_shard },
    { "tasks", "N", " submit ", "shards, each one task (default: one a bed, at most 1000)",
      INTO(tasks), 1, DIG_JOB_TASKS_MAX },
    { "time", "T", " submit ", "time limit of a task, as sbatch takes it", INTO(time) },
    { "partition", "P", " submit ", "where Slurm is to run them", INTO(partition) },
    { "sbatch-arg", "A", " submit ", "one more argument for sbatch; repeatable",
      .take = take_sbatch_arg },
    { "quiet", NULL, " dig generate import submit ", "no progress, only what goes wrong",
      INTO(quiet), .letter = 'q' },
    { "map", "MAP.yaml", " import ", "which column holds what", INTO(map) },
    { "channel", "My|Fx|Fz|carried", " show ", "what to draw (default My)", .take = take_channel },
    { "csv", NULL, " show ", "the curve as CSV", INTO(csv) },
    { "json", NULL, " list check show status ", "the result as JSON", INTO(json) },
    { "runs", NULL, " export ", "the runs behind the curves, not the curves", INTO(runs) },
    { "effects", NULL, " export ", "the curves dug with an effect, not the plain ones",
      INTO(effects) },
    { "complete", NULL, " check ", "end with 1 where the grid has holes or packings are missing",
      INTO(complete) },
};

static const struct dig_program program = {
    .self        = { "digtable", "COMMAND ARGUMENT... [OPTION]...\nCOMMAND --help",
                     "Computes how gravel resists bucket digs, and keeps the curves in a table.", NULL,
                     "digtable generate config/scenes/product.yaml config/grids/product.yaml \\\n"
                            "         -o my.sqlite\n"
                            "digtable show my.sqlite --friction .5 --rolling .5 --density 2500\n" },
    .exit_status = "0  done\n1  the work failed\n2  bad usage or bad input\n",
    .commands    = sizeof commands / sizeof commands[0],
    .command     = commands,
    .options     = sizeof options / sizeof options[0],
    .option      = options,
};

__attribute__((format(printf, 2, 3))) int dig_cli_bad_usage(const struct dig_arguments *const a,
                                                            const char *const format, ...)
{
    char    text[4096];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    dig_options_refuse(&program, a->word, text, stderr);
    return EXIT_BAD_INPUT;
}

struct dig_engine dig_cli_engine(const struct dig_arguments *const a)
{
    struct dig_engine engine = a->engine();
    engine.stepper.threads   = a->threads;
    return engine;
}

int dig_arguments_read(const int argc, char **const argv, struct dig_arguments *const a)
{
    *a = (struct dig_arguments){
        .word         = argv[1],
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
    a->command             = dig_options_read(&program, argc, argv, a, &error);
    if (a->command == NULL) {
        return dig_cli_bad_usage(a, "%s", error.text);
    }
    if (a->seed > INT64_MAX) {
        return dig_cli_bad_usage(a, "--seed %" PRIu64 ": expected a whole number below 2^63",
                                 a->seed);
    }
    a->approach.attack_rad *= DIG_RAD_PER_DEG; // degrees until here
    for (; optind < argc; optind++) {
        if (a->positionals == DIG_POSITIONALS_MAX) {
            return dig_cli_bad_usage(a, "%s: one argument too many", argv[optind]);
        }
        a->positional[a->positionals++] = argv[optind];
    }
    if (a->threads > 0 && !a->has_threads) {
        return dig_cli_bad_usage(a, "--threads: only --engine single and cuda have them");
    }
    if (a->threads == 0 && a->has_threads) {
        a->threads = strcmp(a->command->name, "dig") == 0 ? all_cores() : 1;
    }
    return EXIT_DONE;
}
