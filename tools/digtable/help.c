#include "tools/digtable/help.h"

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
      "Computes a table in shards: here, or with --slurm as a job array.",
      "Plans once, in the folder TABLE.sqlite.jobs, and merges the shards when all are done. The "
      "same command again submits what failed, and only that.",
      "digtable submit scene.yaml grid.yaml -o my.sqlite --slurm --tasks 500 \\\n"
      "         --time 4:00:00\n"
      "digtable submit scene.yaml grid.yaml -o my.sqlite\n" },
    { "status", "TABLE.sqlite [OPTION]...\nFOLDER [OPTION]...",
      "Shows how far a table of `digtable submit` is.", NULL,
      "digtable status my.sqlite\n"
      "digtable status my.sqlite.jobs --json\n" },
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
      "digtable show tables/product.sqlite 0 --channel Fx\n" },
    { "import", "CURVES.csv --map MAP.yaml -o TABLE.sqlite",
      "Adds digs that something else measured or computed to a table.",
      "The map says which column holds what.",
      "digtable import curves.csv --map curve_map.yaml -o measured.sqlite\n" },
    { "merge", "OUT.sqlite IN...", "Puts the runs of all tables, each once, into a new one.",
      "IN is a table, or a folder of them. The bytes of the new table do not depend on their "
      "order.",
      "digtable merge my.sqlite part*.sqlite\n"
      "digtable merge my.sqlite my.sqlite.jobs/shards\n" },
    { "seal", "TABLE.sqlite", "Seals a table of an older version.",
      "The table is checked, and shows a flipped bit from then on whenever it is read.",
      "digtable seal old.sqlite\n" },
    { "export", "TABLE.sqlite [OPTION]...", "Writes all curves of a table as CSV.", NULL,
      "digtable export my.sqlite --runs -o runs.csv\n" },
    { "check", "TABLE.sqlite [OPTION]...",
      "Checks version, integrity, and every curve against the runs it was made of.", NULL,
      "digtable check tables/product.sqlite\n"
      "digtable check my.sqlite --complete --json\n" },
};

static const struct dig_option options[] = {
    { "trajectory", OPTION_TRAJECTORY, "NAME", " dig show ",
      "its name in the scene (show: the entry's first if not given)" },
    { "friction", OPTION_FRICTION, "F", " dig show ", "friction of the gravel, 0 to 3" },
    { "rolling", OPTION_ROLLING, "R", " dig show ", "rolling friction of the gravel, 0 to 3" },
    { "density", OPTION_DENSITY, "KGPM3", " dig show ", "density of the grains in kg/m3" },
    { "depth", OPTION_DEPTH, "F", " dig show ",
      "factor on how far the tooth goes down in the first phase (default 1)" },
    { "attack-deg", OPTION_ATTACK, "A", " dig show ",
      "the bucket turned about its tooth, positive curls (default 0)" },
    { "young", OPTION_YOUNG, "PA", " dig ", "Young's modulus instead of the scene's" },
    { "seed", OPTION_SEED, "N", " dig ", "of the bed (default 1)" },
    { "engine", OPTION_ENGINE, "single|kernel|ode|cuda", " dig generate submit ",
      "single (default): plain gravel in single precision; kernel, in double; ode, the slow "
      "reference; cuda, on a graphics card, with the library of `make cuda`" },
    { "bed", OPTION_BED, "BED.csv", " dig ", "dig this bed instead of pouring one" },
    { "save-bed", OPTION_SAVE_BED, "BED.csv", " dig ", "write the bed before it is dug" },
    { "vtk", OPTION_VTK, "DIR", " dig ", "write grains and bucket for ParaView into DIR" },
    { "output", OPTION_OUTPUT, "CURVE.csv", " dig ", "the curve to write; -: standard output" },
    { "output", OPTION_OUTPUT, "TABLE.sqlite", " generate import submit ",
      "the table to make or to go on with" },
    { "output", OPTION_OUTPUT, "FILE.csv", " export ", "the file to write, not standard output" },
    { "jobs", OPTION_JOBS, "N", " generate submit ", "digs at a time here (default: one a core)" },
    { "threads", OPTION_THREADS, "N", " dig generate ",
      "of engines single and cuda in a bed of more than 30 000 grains (dig: one a core, generate: "
      "1)" },
    { "packings", OPTION_PACKINGS, "N", " generate submit ",
      "beds of each gravel, not the grid's number" },
    { "time-limit", OPTION_TIME_LIMIT, "S", " generate ", "begin no dig after S seconds" },
    { "shard", OPTION_SHARD, "I/N", " generate ",
      "the I-th of N parts alone; `digtable merge` puts the parts together" },
    { "slurm", OPTION_SLURM, NULL, " submit ", "submit to Slurm, do not compute here" },
    { "tasks", OPTION_TASKS, "N", " submit ", "shards, each one task (default: a bed each, 1000)" },
    { "time", OPTION_TIME, "T", " submit ", "time limit of a task, as sbatch takes it" },
    { "partition", OPTION_PARTITION, "P", " submit ", "where Slurm is to run them" },
    { "sbatch-arg", OPTION_SBATCH_ARG, "A", " submit ",
      "one more argument for sbatch; repeatable" },
    { "quiet", OPTION_QUIET, NULL, " dig generate import seal submit ",
      "no progress, only what goes wrong" },
    { "map", OPTION_MAP, "MAP.yaml", " import ", "which column holds what" },
    { "channel", OPTION_CHANNEL, "My|Fx|Fz|carried", " show ", "what to draw (default My)" },
    { "csv", OPTION_CSV, NULL, " show ", "the curve as CSV" },
    { "json", OPTION_JSON, NULL, " list check show status ", "the result as JSON" },
    { "runs", OPTION_RUNS, NULL, " export ", "all runs behind the curves, instead" },
    { "effects", OPTION_EFFECTS, NULL, " export ", "those dug with an effect, instead" },
    { "complete", OPTION_COMPLETE, NULL, " check ",
      "holes in the grid and missing packings fail, too" },
};

const struct dig_program *dig_cli_program(void)
{
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
    return &program;
}
