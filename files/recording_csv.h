// Force recordings and machine recordings as CSV (docs/formats.md): a header line, SI, `#`
// lines are comments, missing samples are empty fields.

#ifndef DIG_FILES_RECORDING_CSV_H
#define DIG_FILES_RECORDING_CSV_H

#include "core/error.h"
#include "core/recording.h"

#include <stdbool.h>
#include <stdio.h>

/// Read a whole file. DIG_EINVAL names file, line, column and what was expected: unknown or missing
/// columns (of forces all but My_Nm, of a machine the boom's and arm's pressures, pitch and
/// temperature may be missing; NaN in a force row), text where a
/// number belongs, NaN or infinity, time that does not ascend, sampling below 50 Hz, fewer than two
/// rows. A machine recording with a column sensor_My_Nm is of a rig with a force sensor, which has
/// no boom, arm and cylinders (core/machine.h); an LCM log of the daemon is one, too
/// (files/lcm/lcm_log.h). DIG_EIO: errno's text. *recording is written on success only.
DIG_MUST_CHECK enum dig_status dig_recording_read(const char *path, struct dig_recording *recording,
                                                  struct dig_error *error);
DIG_MUST_CHECK enum dig_status dig_machine_recording_read(const char                   *path,
                                                          struct dig_machine_recording *recording,
                                                          struct dig_error             *error);

/// True when the header of path names the columns of a machine recording, of either kind.
bool dig_machine_recording_is(const char *path);

/// Write a whole file: into PATH.part, then renamed, so that no half file is ever left behind.
DIG_MUST_CHECK enum dig_status dig_recording_write(const char                 *path,
                                                   const struct dig_recording *recording,
                                                   struct dig_error           *error);
DIG_MUST_CHECK enum dig_status
dig_machine_recording_write(const char *path, const struct dig_machine_recording *recording,
                            struct dig_error *error);

#endif // DIG_FILES_RECORDING_CSV_H
