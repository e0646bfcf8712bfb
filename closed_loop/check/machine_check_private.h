// Inside of the check of a machine file, for closed_loop/check/machine_check*.c.

#ifndef DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_PRIVATE_H
#define DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_PRIVATE_H

#include "closed_loop/check/machine_check.h"
#include "closed_loop/machine_digs/machine_dig.h"
#include "core/units.h"

/// A joint that turns by less is not asked about.
#define DIG_CHECK_LEAST_TURN_rad (10.0 * DIG_RAD_PER_DEG)

/// One more line. NaN: no such number.
struct dig_check_item *dig_check_add(struct dig_machine_air_check *check,
                                     enum dig_check_question question, int of, double value,
                                     double tolerance, enum dig_check_verdict verdict);

/// OK, doubtful beyond one value, wrong beyond another.
enum dig_check_verdict dig_check_grade(double value, double doubtful, double wrong);

/// Least and most of a signal's valid readings.
void dig_check_range(size_t samples, const struct dig_sample sample[], size_t signal,
                     double range[2]);

/// Times, gaps, what is missing, and what is stuck; takes that out of the recording: there it is
/// missing.
void dig_check_recording(const struct dig_machine *machine, struct dig_machine_recording *recording,
                         struct dig_machine_air_check *check);

/// How far the joints go, read as is best.
void dig_check_motion(const struct dig_machine *machine, const struct dig_machine_dig *dig,
                      struct dig_machine_air_check *check);

#endif // DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_PRIVATE_H
