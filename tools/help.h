// The help of a program with commands: of all of them, or of one.

#ifndef DIG_TOOLS_HELP_H
#define DIG_TOOLS_HELP_H

#include <stdio.h>
#include <string.h>

/// One command, each text in lines that end in '\n'.
struct dig_help {
    const char *name;
    const char *usage;    // how it is called
    const char *text;     // what it does
    const char *examples; // "" for none
};

/// What a program says of itself before its commands, and after them.
struct dig_help_of_program {
    const char            *intro, *others, *exit_codes; // others: how it is called without command
    size_t                 commands;
    const struct dig_help *command;
};

/// Prints the help of the command called name, or of all when none is called so.
static inline void dig_help_print(const struct dig_help_of_program *const program,
                                  const char *const name, FILE *const to)
{
    size_t first = 0;
    size_t end   = program->commands;
    for (size_t i = 0; i < program->commands; i++) {
        if (strcmp(program->command[i].name, name) == 0) {
            first = i;
            end   = i + 1;
        }
    }
    const int one = end - first == 1;
    (void)fprintf(to, "%susage:\n", one ? "" : program->intro);
    for (size_t i = first; i < end; i++) {
        (void)fprintf(to, "%s%s", program->command[i].usage, program->command[i].text);
    }
    (void)fprintf(to, "%s\n%s\nexamples:\n", one ? "" : program->others, program->exit_codes);
    for (size_t i = first; i < end; i++) {
        (void)fputs(program->command[i].examples, to);
    }
}

#endif // DIG_TOOLS_HELP_H
