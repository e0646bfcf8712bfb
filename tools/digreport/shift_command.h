// digreport shift: its command line and its job.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H
#define DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H

#include "core/error.h"

/// argv[0] is the command's name. Prints help and exits where asked to. DIG_EINVAL: bad usage or
/// bad input, *error says what is wrong.
DIG_MUST_CHECK enum dig_status digreport_shift_command(int argc, char *argv[],
                                                       struct dig_error *error);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H
