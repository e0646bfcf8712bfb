#include "tools/digtable/commands.h"

#include "tools/help.h"

#include <stdio.h>

static const struct dig_help commands[] = {
    { "dig",
      "  digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density KGPM3\n"
      "               [--depth F] [--attack-deg A] [--young PA] [--seed 1]\n"
      "               [--engine kernel|ode|cuda] [--bed BED.csv] [--save-bed BED.csv]\n"
      "               [--vtk DIR] -o CURVE.csv\n",
      "      one dig; the curve is a force recording. --depth: factor on how far the tooth goes\n"
      "      down in the first phase; --attack-deg: the bucket turned about its tooth, positive\n"
      "      curls\n",
      "  digtable dig config/scenes/rig.yaml --trajectory simpleA --friction .5 --rolling .5 \\\n"
      "           --density 2500 -o dig.csv\n" },
    { "generate",
      "  digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite\n"
      "               [-j N] [--packings N] [--time-limit S] [--shard I/N]\n"
      "               [--engine kernel|ode|cuda]\n",
      "      every dig of the grid, on all cores; what the table holds already is not computed\n"
      "      again, and Ctrl-C keeps all that is finished\n"
      "      --engine cuda: on a graphics card, with the library of `make cuda`\n",
      "  digtable generate config/scenes/rig.yaml config/grids/rig.yaml -o rig.sqlite \\\n"
      "           --time-limit 3600\n"
      "  digtable generate config/scenes/rig.yaml config/grids/rig.yaml -o part3.sqlite \\\n"
      "           --shard 3/16\n" },
    { "list", "  digtable list TABLE.sqlite [--json]\n",
      "      the entries and how many packings each has\n", "  digtable list tables/rig.sqlite\n" },
    { "show",
      "  digtable show TABLE.sqlite ENTRY | --friction F --rolling R --density KGPM3\n"
      "               [--depth F] [--attack-deg A] [--trajectory NAME]\n"
      "               [--channel My|Fx|Fz|carried] [--csv|--json]\n",
      "      one curve of the table\n",
      "  digtable show rig.sqlite --friction .5 --rolling .5 --density 2500 --trajectory "
      "actual\n" },
    { "import", "  digtable import CURVES.csv --map MAP.yaml -o TABLE.sqlite\n",
      "      digs that something else measured or computed; the map says which column holds what\n",
      "  digtable import curves.csv --map curve_map.yaml -o measured.sqlite\n" },
    { "merge", "  digtable merge OUT.sqlite IN.sqlite...\n",
      "      the runs of all tables, each once, in a new one, whose bytes do not depend on their\n"
      "      order\n",
      "  digtable merge rig.sqlite part*.sqlite\n" },
    { "seal", "  digtable seal TABLE.sqlite\n",
      "      makes a table of an older version one that shows a flipped bit when it is read, "
      "after\n"
      "      a check\n",
      "  digtable seal old.sqlite\n" },
    { "export", "  digtable export TABLE.sqlite [--effects|--runs] [-o FILE.csv]\n",
      "      all curves; those dug with an effect; or all runs behind them\n",
      "  digtable export rig.sqlite --runs -o runs.csv\n" },
    { "check", "  digtable check TABLE.sqlite [--complete] [--json]\n",
      "      version, integrity, and every curve against the runs it was made of; with\n"
      "      --complete, holes and missing packings fail too\n",
      "  digtable check tables/rig.sqlite\n" },
};

void dig_cli_help(const char *const command)
{
    const struct dig_help_of_program program = {
        .intro      = "digtable computes how gravel resists bucket digs, and keeps the curves in a "
                      "table.\n\n",
        .others     = "  digtable --help | --version, digtable COMMAND --help\n",
        .exit_codes = "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n",
        .commands   = sizeof commands / sizeof commands[0],
        .command    = commands,
    };
    dig_help_print(&program, command, stdout);
}
