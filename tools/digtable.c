// digtable: the analyst's tool. Computes digs and tables of digs, and shows what a table holds.
//
//   digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density D -o CURVE.csv
//   digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite
//   digtable list|check|show|export TABLE.sqlite

#include "tools/digtable/commands.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

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
        dig_cli_help("");
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
                dig_cli_help(commands[i].name);
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
