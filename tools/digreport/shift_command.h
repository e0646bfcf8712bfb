// digreport shift.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H
#define DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H

#include "tools/digreport/options.h"

/// DIG_EINVAL: bad input, *error says what is wrong. A page fails as dig_plot_figure().
DIG_MUST_CHECK enum dig_status digreport_shift_command(const struct digreport_options *options,
                                                       struct dig_error               *error);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_COMMAND_H
