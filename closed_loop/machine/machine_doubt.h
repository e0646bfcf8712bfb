// What may explain free air in the place of effects.
//
// A machine that is not the one its file tells: what the file may have wrong (enum dig_file_error)
// has a prior, and free air says what it is.
// Of a machine like its file an error's mean by free air, in its tolerances, has mean 0 and
// variance 1 - C, C being what free air leaves of the prior's (the law of total variance). So
// z / sqrt(1 - C) is standard normal, whatever the air tells of it. The largest of n such is as
// rare as n times its own tail.
//
// Pressure sensors that read otherwise as the oil warms or from dig to dig. No effect of the list
// does that, but some can pretend to for a few digs: a payload of its own for every dig most of
// all. As machine_fit.h: linear in what each chamber's gain and each drive's offset grow by with
// what was recorded, normal priors of a few widths, the evidence closed form.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_DOUBT_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_DOUBT_H

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

/// What the sensors' errors would follow, and how much that explains.
struct dig_machine_drift {
    double      log_evidence; // against no effect at all, as of a set of effects
    double      log_lead;     // of it, against the same errors that stay as they are
    const char *follows;      // for people
};

/// Asks the air as the lines stand, without any effect, rows as far as they are trusted; s2: the
/// variance of the noise in the rows' sigmas. -INFINITY where nothing that was recorded differs.
/// Some milliseconds.
struct dig_machine_drift dig_machine_drift_ask(const struct dig_lines *lines, double s2);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_DOUBT_H
