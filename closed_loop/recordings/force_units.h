// Whether forces are of the size that the table knows: recorded in kN they are a thousandth.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_FORCE_UNITS_H
#define DIG_CLOSED_LOOP_RECORDINGS_FORCE_UNITS_H

#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/error.h"

/// DIG_EINVAL: the moment, or both forces together, are nearer to a thousandth of what the table's
/// weakest gravel resists with along that trajectory than to that, or so much more than what its
/// strongest does. *error names the columns. O(entries).
DIG_MUST_CHECK enum dig_status dig_force_units_check(const struct dig_curve_set *set,
                                                     const struct dig_measured  *dig,
                                                     struct dig_error           *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_FORCE_UNITS_H
