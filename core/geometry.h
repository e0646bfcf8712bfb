// Checks whether a machine could be built and would move, by comparing geometry and masses of its
// file with each other. A slip of a unit, a sign or a digit shows here before it shows as a moment.

#ifndef DIG_CORE_GEOMETRY_H
#define DIG_CORE_GEOMETRY_H

#include "core/error.h"
#include "core/machine.h"
#include "core/status.h"

/// A joint's limits are known to about this: by as much a cylinder may overrun its stops.
#define DIG_GEOMETRY_ANGLE_TOLERANCE_rad 0.0087 // half a degree

/// The share of a joint's range that its cylinder's stroke is, at least.
#define DIG_GEOMETRY_LEAST_RANGE 0.5

/// A lever below this share of its largest one is near a dead centre.
#define DIG_GEOMETRY_LEAST_LEVER 0.05

/// For a machine as its file says, after dig_machine_check(). DIG_EINVAL, with the key, what was
/// found and what was expected in *error, for
///
///   - limits of a joint less than ten degrees apart: they were given in radians
///   - a linkage that does not close somewhere between min_deg and max_deg
///   - a cylinder whose stroke, min_length_m to max_length_m, is less than half of that range. A
///     stop within the range is no fault: the machine then does not reach the end of it, and the
///     estimator says so of what it measures there (estimator/wrench/wrench.h)
///   - a lever that between the stops changes sign or falls below a twentieth of its largest
///   - a cylinder that extends to twice its retracted length or more: its rod would not go in
///   - a centre of mass farther from its pin than 1.25 times the link's length, or an inertia about
///     it of more than mass times the square of that. What hangs on a force sensor may reach as far
///     beyond the pin as the sensor is away
///   - a bucket longer than twice its arm, a front heavier than the machine that carries it
///
/// A corrected machine is not asked: its stops stay where the file's geometry has them
/// (estimator/wrench/correction.h). A fraction of a millisecond.
DIG_MUST_CHECK enum dig_status dig_geometry_check(const struct dig_machine *machine,
                                                  struct dig_error         *error);

#endif // DIG_CORE_GEOMETRY_H
