// digtable: the analyst's tool. Computes digs and tables of digs, and shows what a table holds.

#include "core/streams.h"
#include "tools/digtable/commands.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int (*run)(const struct dig_arguments *a);
    int least, most; // arguments that are no options
} commands[] = {
    { "dig", dig_cli_dig, 1, 1 },
    { "generate", dig_cli_generate, 2, 2 },
    { "submit", dig_cli_submit, 2, 2 },
    { "status", dig_cli_status, 1, 1 },
    { "list", dig_cli_list, 1, 1 },
    { "check", dig_cli_check, 1, 1 },
    { "show", dig_cli_show, 1, 2 },
    { "import", dig_cli_import, 1, 1 },
    { "merge", dig_cli_merge, 2, DIG_POSITIONALS_MAX },
    { "export", dig_cli_export, 1, 1 },
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

static int run(const struct dig_arguments *const a)
{
    size_t i = 0;
    while (strcmp(commands[i].name, a->command->name) != 0) {
        i++;
    }
    if (a->positionals > commands[i].most) {
        return dig_cli_bad_usage(a, "%s: one argument too many", a->positional[commands[i].most]);
    }
    if (a->positionals < commands[i].least) {
        return dig_cli_bad_usage(a, "%s: expected %s", a->command->name, a->command->usage);
    }
    return commands[i].run(a);
}

int main(const int argc, char **const argv)
{
    struct dig_arguments a;
    dig_streams_begin();
    const int code = dig_arguments_read(argc, argv, &a);
    if (code != EXIT_DONE) {
        return code;
    }
    a.stop = &stop_requested;
    catch_signals();
    return dig_streams_end("digtable", run(&a));
}
