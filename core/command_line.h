// The command line of a program: its commands and options, each once, in a table. getopt_long
// reads by it, --help (core/help.h) prints it, and what --help prints becomes manual pages
// (scripts/man_pages.sh) and bash completion (scripts/completion.bash).

#ifndef DIG_CORE_COMMAND_LINE_H
#define DIG_CORE_COMMAND_LINE_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/// --help (-h) and --version need no row.
struct dig_option {
    const char *name;     // the long one
    int         id;       // what dig_option_next() returns; a letter is the short option, too
    const char *value;    // "CURVE.csv" or "kernel|ode|cuda"; NULL: it takes none
    const char *commands; // " dig show ": which take it; NULL: all
    const char *text;     // what it does: no capital, no full stop
};

struct dig_command {
    const char *name;
    const char *usage;    // what stands behind the name; a line for each way to call it
    const char *summary;  // a sentence
    const char *text;     // what else is to be known, a line a paragraph; NULL: nothing
    const char *examples; // lines, as they are typed
};

/// A program; self is how it is called without command.
struct dig_program {
    struct dig_command        self;
    const char               *exit_status; // lines, "0  done\n"
    bool                      alone;       // it may be called without command, too
    size_t                    commands, options;
    const struct dig_command *command;
    const struct dig_option  *option;
};

enum { DIG_OPTION_END = -1, DIG_OPTION_WRONG = '?', DIG_OPTION_HELP = 'h', DIG_OPTION_VERSION = 1 };

/// The command called name, argv[1]; &program->self for an option. NULL, with *error, for an
/// unknown one and for NULL, none.
const struct dig_command *dig_command_find(const struct dig_program *program, const char *name,
                                           struct dig_error *error);

/// The next option of the command in the whole command line: its id, its value in getopt's optarg.
/// DIG_OPTION_END: none is left, and what is no option stands from getopt's optind on.
/// DIG_OPTION_WRONG fills *error; so does the end, where a command is missing. Set optind to 0
/// before a second command line.
int dig_option_next(const struct dig_program *program, const struct dig_command *command, int argc,
                    char *argv[], struct dig_error *error);

/// True for an option that the command takes.
bool dig_option_belongs(const struct dig_option *option, const struct dig_command *command);

/// A number, all of text, from least to most. False leaves *value; NaN is never in the range.
bool dig_number_read(const char *text, double least, double most, double *value);

#endif // DIG_CORE_COMMAND_LINE_H
