// The text of --help, from a program's table.

#ifndef DIG_CORE_HELP_H
#define DIG_CORE_HELP_H

#include "core/command_line.h"

#include <stdio.h>

/// True for an option that the command takes.
bool dig_option_belongs(const struct dig_option *option, const struct dig_command *command);

/// The help of the command; for &program->self, of the program, with a line for each command. At
/// most 79 columns, but for what does not break. help2man reads it.
void dig_help_print(const struct dig_program *program, const struct dig_command *command, FILE *to);

#endif // DIG_CORE_HELP_H
