// Pressure sensors that read otherwise as the oil warms or from dig to dig. No effect of the list
// does that, but some can pretend to for a few digs: a payload of its own for every dig most of
// all.
//
// As machine_fit.h: linear in what each chamber's gain and each drive's offset grow by with what
// was recorded, normal priors of a few widths, the evidence closed form.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_DRIFT_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_DRIFT_H

#include "closed_loop/machine/machine_lines.h"

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

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_DRIFT_H
