// The command line of digtable, and its error messages.

#ifndef DIG_TOOLS_DIGTABLE_ARGUMENTS_H
#define DIG_TOOLS_DIGTABLE_ARGUMENTS_H

#include "core/approach.h"
#include "core/command_line.h"
#include "core/curve.h"
#include "core/error.h"

#include <signal.h>
#include <stdbool.h>

enum { EXIT_DONE = 0, EXIT_WORK_FAILED = 1, EXIT_BAD_INPUT = 2 };

#define DIG_POSITIONALS_MAX 1024 // tables to merge
#define DIG_SBATCH_ARGS_MAX 32   // --sbatch-arg

struct dig_engine; // offline_dem/sweep/sweep.h

/// Every option of every command, with its default where it was not given.
struct dig_arguments {
    const struct dig_command *command;
    const char               *word; // argv[1]
    const char               *positional[DIG_POSITIONALS_MAX];
    int                       positionals;
    const char               *output, *trajectory, *bed, *save_bed, *vtk, *map;
    double                    gravel[DIG_AXES];        // NaN: not given
    struct dig_approach       approach;                // plain: not given
    double                    young_Pa;                // NaN: the scene's
    uint64_t                  seed, workers, packings; // 0 packings: the grid's
    uint64_t                  threads;                 // of a large bed
    uint64_t                  shard, shards;           // from 0; 0 shards: all
    uint64_t                  tasks;                   // 0: not given
    const char               *time, *partition, *sbatch_arg[DIG_SBATCH_ARGS_MAX]; // for Slurm
    size_t                    sbatch_args;
    double                    time_limit_s;
    enum dig_channel          channel;
    struct dig_engine (*engine)(void);
    bool has_threads; // the engine
    bool csv, json, runs, effects, complete, quiet;
    // Set by a signal: what is finished is kept.
    const volatile sig_atomic_t *stop;
};

/// Reads the whole command line. EXIT_DONE, or what to exit with after a message; prints help or
/// version and exits where asked to.
int dig_arguments_read(int argc, char **argv, struct dig_arguments *a);

/// The engine that --engine names.
struct dig_engine dig_cli_engine(const struct dig_arguments *a);

/// Print to stderr and return the exit code: bad usage; bad input, which is the user's to mend but
/// for a lack of memory; work that failed, be it for its input or not.
__attribute__((format(printf, 2, 3))) int dig_cli_bad_usage(const struct dig_arguments *a,
                                                            const char *format, ...);
int dig_cli_bad_input(enum dig_status status, const struct dig_error *error);
int dig_cli_work_failed(enum dig_status status, const struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_ARGUMENTS_H
