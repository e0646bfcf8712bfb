// Misfit of two columns of pressures, taken for the chambers of a drive, with the load that the
// drive bears in free air.
//
// Coarse on purpose. A file may be wrong by some per cent and a sensor by some bar without anything
// being mixed up. So the residual counts relative to the load, after a constant force, a factor of
// the load and dry friction, all within bounds, are fitted.

#ifndef DIG_CLOSED_LOOP_CHECK_DRIVE_MISFIT_H
#define DIG_CLOSED_LOOP_CHECK_DRIVE_MISFIT_H

#include "closed_loop/air/machine_air.h"
#include "closed_loop/check/machine_reading.h"
#include "core/machine.h"

#include <stddef.h>

/// What a drive would have to push at an instant (NaN where its joint cannot stand like that), and
/// the share of its dry friction that it would have to overcome: 1 where the rod comes out, -1
/// where it goes in.
struct dig_drive_load {
    double load_N;
    double rubs;
};

/// Of each drive at n instants while their angles, which are in radians, are read so:
/// load[n * joint + instant].
void dig_drive_loads(const struct dig_machine *machine, const struct dig_reading *reading, size_t n,
                     const struct dig_air_point at[], struct dig_drive_load load[]);

/// A drive, and the signals that its chambers are read from.
struct dig_drive_read {
    const struct dig_cylinder *cylinder;
    size_t                     head, rod;
};

/// Minus the log likelihood of the readings of n instants, so many times as large as they say, for
/// each such factor, by the load at each of them. poses: so many of the instants count as seen each
/// for itself.
void dig_drive_misfits(const struct dig_drive_read *read, size_t n, const struct dig_air_point at[],
                       const struct dig_drive_load load[], double poses, size_t factors,
                       const double factor[], double misfits[]);

#endif // DIG_CLOSED_LOOP_CHECK_DRIVE_MISFIT_H
