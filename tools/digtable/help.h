// The command line of digtable: its commands, and the options of them all.

#ifndef DIG_TOOLS_DIGTABLE_HELP_H
#define DIG_TOOLS_DIGTABLE_HELP_H

#include "core/command_line.h"

/// A letter is an option's short name, too.
enum dig_cli_option {
    OPTION_OUTPUT     = 'o',
    OPTION_JOBS       = 'j',
    OPTION_QUIET      = 'q',
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
    OPTION_THREADS,
    OPTION_PACKINGS,
    OPTION_TIME_LIMIT,
    OPTION_SHARD,
    OPTION_TASKS,
    OPTION_SLURM,
    OPTION_TIME,
    OPTION_PARTITION,
    OPTION_SBATCH_ARG,
    OPTION_CHANNEL,
    OPTION_CSV,
    OPTION_JSON,
    OPTION_RUNS,
    OPTION_EFFECTS,
    OPTION_COMPLETE,
};

const struct dig_program *dig_cli_program(void);

#endif // DIG_TOOLS_DIGTABLE_HELP_H
