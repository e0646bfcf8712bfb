// Pressures of a machine recording in another unit, or of sensors that are dead: a bucket of
// another gravel, to whoever takes them.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_PRESSURE_CHECK_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_PRESSURE_CHECK_H

#include "core/machine.h"
#include "core/recording.h"

/// DIG_EINVAL where
///
///   * the greatest pressure of the recording is below a hundredth of relief_Pa: no machine holds
///     its boom, or digs, with so little,
///   * one in a hundred pressures of a chamber is above twice relief_Pa, which opens there,
///   * both chambers of a drive have one value each all along.
///
/// Without pressures there is nothing to check. O(rows).
DIG_MUST_CHECK enum dig_status dig_pressure_check(const struct dig_machine           *machine,
                                                  const struct dig_machine_recording *recording,
                                                  struct dig_error                   *error);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_PRESSURE_CHECK_H
