// The commands of digtable: each returns the exit code, after a message where it is not EXIT_DONE.

#ifndef DIG_TOOLS_DIGTABLE_COMMANDS_H
#define DIG_TOOLS_DIGTABLE_COMMANDS_H

#include "tools/digtable/arguments.h"

int dig_cli_dig(const struct dig_arguments *a);
int dig_cli_generate(const struct dig_arguments *a);
int dig_cli_submit(const struct dig_arguments *a);
int dig_cli_status(const struct dig_arguments *a);
int dig_cli_list(const struct dig_arguments *a);
int dig_cli_check(const struct dig_arguments *a);
int dig_cli_show(const struct dig_arguments *a);
int dig_cli_import(const struct dig_arguments *a);
int dig_cli_merge(const struct dig_arguments *a);
int dig_cli_export(const struct dig_arguments *a);

#endif // DIG_TOOLS_DIGTABLE_COMMANDS_H
