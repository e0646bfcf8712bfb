// The command line of a program: its commands and options, each once, in a table. getopt_long
// reads by it, --help (core/help.h) prints it, and what --help prints becomes manual pages
// (scripts/man_pages.sh) and bash completion (scripts/completion.bash).

#ifndef DIG_CORE_COMMAND_LINE_H
#define DIG_CORE_COMMAND_LINE_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum dig_option_kind {
    DIG_OPTION_CALL,
    DIG_OPTION_TEXT,
    DIG_OPTION_FLAG,
    DIG_OPTION_NUMBER,
    DIG_OPTION_COUNT
};

/// An option; --help (-h) and --version need no row. A row ends with where its value goes:
/// DIG_INTO() a field, or to take(), which says in *error what is wrong with it.
struct dig_option {
    const char *name;     // the long one
    const char *value;    // "CURVE.csv" or "kernel|ode|cuda"; NULL: it takes none
    const char *commands; // " dig show ": which take it; NULL: all
    const char *text;     // what it does: no capital, no full stop
    size_t      offset;
    double      least, most; // of a number or count; both 0: any count
    const char *unit;        // of these; NULL: none
    enum dig_status (*take)(const char *value, void *into, struct dig_error *error);
    enum dig_option_kind kind;
    bool                 clears; // the field of a flag
    bool                 writes; // the file named: no other word of the line may name it
    char                 letter; // the short one; 0: none
};

/// The field that an option fills: a const char * with its value as it stands, a bool with true, a
/// double or uint64_t with a number. Behind it least, most and unit may stand.
// clang-format off
#define DIG_INTO(type, field)                                                                      \
    .kind = _Generic(((type *)0)->field, const char *: DIG_OPTION_TEXT, bool: DIG_OPTION_FLAG,     \
                     double: DIG_OPTION_NUMBER, uint64_t: DIG_OPTION_COUNT),                       \
    .offset = offsetof(type, field)
// clang-format on

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

/// Reads the whole command line into *into, the struct that the options' fields are of, and returns
/// its command, which is argv[1]; &program->self where there is none to name. Prints help or
/// version and exits where asked to. What is no option stands from getopt's optind on. NULL, with
/// *error, for a command or option that is wrong or missing; *into is then filled in part.
DIG_MUST_CHECK const struct dig_command *dig_options_read(const struct dig_program *program,
                                                          int argc, char *argv[], void *into,
                                                          struct dig_error *error);

/// What is wrong with a command line, and where help stands: that of the command which word names,
/// argv[1], else the program's.
void dig_options_refuse(const struct dig_program *program, const char *word, const char *wrong,
                        FILE *to);

/// A number, all of text, from least to most. False leaves *value; NaN is never in the range.
bool dig_number_read(const char *text, double least, double most, double *value);

/// As dig_number_read(), of a whole number without sign.
bool dig_count_read(const char *text, uint64_t least, uint64_t most, uint64_t *value);

#endif // DIG_CORE_COMMAND_LINE_H
