// Whether the machine is the one that its file tells: what the file may have wrong (enum
// dig_file_error) has a prior, and free air says what it is.
//
// Of a machine like its file an error's mean by free air, in its tolerances, has mean 0 and
// variance 1 - C, C being what free air leaves of the prior's (the law of total variance). So
// z / sqrt(1 - C) is standard normal, whatever the air tells of it. The largest of n such is as
// rare as n times its own tail.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_UNLIKE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_UNLIKE_H

#include "closed_loop/machine/machine_fit.h"

/// The prior of an error that is larger than its tolerance, in tolerances: as the widest of an
/// effect.
#define DIG_UNLIKE_WIDTH 4.0

/// The error of the file that is farthest from what it should be.
struct dig_machine_unlike {
    bool   is;           // farther than chance has it at the level asked for
    double p;            // of one as far in any of the errors
    size_t column;       // of the lines
    double log_evidence; // of a file with this error alone, however large, as fit->log_none is
};

/// Asks the equations as they stand, without any effect.
struct dig_machine_unlike dig_machine_unlike_ask(const struct dig_fit *fit, double level);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_UNLIKE_H
