// Whether forces are recorded as the table has them: in its unit, in its direction, by a sensor
// that reads anything.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_FORCE_CHECK_H
#define DIG_CLOSED_LOOP_RECORDINGS_FORCE_CHECK_H

#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/error.h"

/// DIG_EINVAL: the moment, or both forces together,
///
///   * have one value all along the dig,
///   * are nearer to a thousandth of what the table's weakest gravel resists with along that
///     trajectory than to that, or so much more than what its strongest does,
///   * run against every gravel of the table, as what the bucket does to the soil.
///
/// *error names the columns. O(entries).
DIG_MUST_CHECK enum dig_status dig_force_check(const struct dig_curve_set *set,
                                               const struct dig_measured  *dig,
                                               struct dig_error           *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_FORCE_CHECK_H
