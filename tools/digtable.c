// digtable: the analyst's tool. Computes digs and tables of digs, and shows what a table holds.
//
//   digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density D -o CURVE.csv
//   digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite
//   digtable list|check|show|export TABLE.sqlite

#include "tools/digtable/commands.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

static const char help_text[] =
    "digtable computes how gravel resists bucket digs, and keeps the curves in a table.\n"
    "\n"
    "usage:\n"
    "  digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density KGPM3\n"
    "               [--depth F] [--attack-deg A] [--young PA] [--seed 1]\n"
    "               [--engine kernel|ode|cuda] [--bed BED.csv] [--save-bed BED.csv]\n"
    "               [--vtk DIR] -o CURVE.csv\n"
    "      one dig; the curve is a force recording. --depth: factor on how far the tooth goes "
    "down\n"
    "      in the first phase; --attack-deg: the bucket turned about its tooth, positive curls\n"
    "  digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite\n"
    "               [-j N] [--packings N] [--time-limit S] [--shard I/N]\n"
    "               [--engine kernel|ode|cuda]\n"
    "      every dig of the grid, on all cores; what the table holds already is not computed "
    "again,\n"
    "      and Ctrl-C keeps all that is finished\n"
    "      --engine cuda: on a graphics card, with the library of `make cuda`\n"
    "  digtable list TABLE.sqlite [--json]\n"
    "      the entries and how many packings each has\n"
    "  digtable show TABLE.sqlite ENTRY | --friction F --rolling R --density KGPM3\n"
    "               [--depth F] [--attack-deg A] [--trajectory NAME] [--channel My|Fx|Fz|carried]\n"
    "               [--csv|--json]\n"
    "      one curve of the table\n"
    "  digtable import CURVES.csv --map MAP.yaml -o TABLE.sqlite\n"
    "      digs that something else measured or computed; the map says which column holds what\n"
    "  digtable merge OUT.sqlite IN.sqlite...\n"
    "      the runs of all tables, each once, in a new one, whose bytes do not depend on their "
    "order\n"
    "  digtable export TABLE.sqlite [--effects|--runs] [-o FILE.csv]\n"
    "      all curves; those dug with an effect; or all runs behind them\n"
    "  digtable check TABLE.sqlite [--complete] [--json]\n"
    "      version, integrity, and every curve against the runs it was made of; with --complete,\n"
    "      holes and missing packings fail too\n"
    "  digtable seal TABLE.sqlite\n"
    "      makes a table of an older version one that tells a flipped bit when it is read, after a "
    "check\n"
    "  digtable --help | --version\n"
    "\n"
    "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n"
    "\n"
    "examples:\n"
    "  digtable dig config/scenes/rig.yaml --trajectory simpleA --friction .5 --rolling .5 \\\n"
    "           --density 2500 -o dig.csv\n"
    "  digtable generate config/scenes/rig.yaml config/grids/rig.yaml -o rig.sqlite "
    "--time-limit 3600\n"
    "  digtable generate config/scenes/rig.yaml config/grids/rig.yaml -o part3.sqlite --shard "
    "3/16\n"
    "  digtable merge rig.sqlite part*.sqlite\n"
    "  digtable show rig.sqlite --friction .5 --rolling .5 --density 2500 --trajectory actual\n"
    "  digtable export rig.sqlite --runs -o runs.csv\n";

static const struct dig_command commands[] = {
    { "dig", dig_cli_dig, 1, 1, "SCENE.yaml",
      " trajectory friction rolling density depth attack-deg young seed engine bed save-bed vtk "
      "output " },
    { "generate", dig_cli_generate, 2, 2, "SCENE.yaml GRID.yaml",
      " output jobs packings time-limit shard engine " },
    { "list", dig_cli_list, 1, 1, "TABLE.sqlite", " json " },
    { "check", dig_cli_check, 1, 1, "TABLE.sqlite", " json complete " },
    { "show", dig_cli_show, 1, 2, "TABLE.sqlite",
      " friction rolling density depth attack-deg trajectory channel csv json " },
    { "import", dig_cli_import, 1, 1, "CURVES.csv", " map output " },
    { "merge", dig_cli_merge, 2, DIG_POSITIONALS_MAX, "OUT.sqlite IN.sqlite…", " " },
    { "seal", dig_cli_seal, 1, 1, "TABLE.sqlite", " " },
    { "export", dig_cli_export, 1, 1, "TABLE.sqlite", " runs effects output " },
};

// Ctrl-C and a polite kill: what is finished is kept.
static volatile sig_atomic_t stop_requested;

static void request_stop(const int signal)
{
    (void)signal;
    stop_requested = 1;
}

static void catch_signals(void)
{
    const struct sigaction action = { .sa_handler = request_stop, .sa_flags = 0 };
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

int main(const int argc, char **const argv)
{
    if (argc < 2) {
        return dig_cli_bad_usage("%s", "expected a command");
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        (void)fputs(help_text, stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        (void)puts("digtable " DIG_VERSION);
        return EXIT_DONE;
    }
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        if (strcmp(commands[i].name, argv[1]) != 0) {
            continue;
        }
        for (int k = 2; k < argc; k++) {
            if (strcmp(argv[k], "--help") == 0) {
                (void)fputs(help_text, stdout);
                return EXIT_DONE;
            }
        }
        struct dig_arguments a;
        const int            code = dig_arguments_read(&commands[i], argc - 1, argv + 1, &a);
        if (code != EXIT_DONE) {
            return code;
        }
        a.stop = &stop_requested;
        catch_signals();
        return commands[i].run(&a);
    }
    return dig_cli_bad_usage("%s: unknown command", argv[1]);
}
