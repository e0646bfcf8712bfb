// The command line of digloop: its commands, and the options of them all.

#ifndef DIG_TOOLS_DIGLOOP_HELP_H
#define DIG_TOOLS_DIGLOOP_HELP_H

#include "core/command_line.h"

/// A letter is an option's short name, too.
enum digloop_option {
    DIGLOOP_OUTPUT     = 'o',
    DIGLOOP_QUIET      = 'q',
    DIGLOOP_IDENTIFIED = 256,
    DIGLOOP_TRAJECTORY,
    DIGLOOP_MACHINE,
    DIGLOOP_MODEL,
    DIGLOOP_MOMENT_ALONE,
    DIGLOOP_MEASURED,
    DIGLOOP_DEPTH,
    DIGLOOP_ATTACK,
    DIGLOOP_EFFECTS,
    DIGLOOP_JSON,
    DIGLOOP_HTML,
    DIGLOOP_ADD,
};

const struct dig_program *digloop_program(void);

#endif // DIG_TOOLS_DIGLOOP_HELP_H
