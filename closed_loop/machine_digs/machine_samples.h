// Which samples of a machine's recording can be used: those in time with all angles, the pressures
// of the bucket's drive, and of every other drive that most of them tell.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_SAMPLES_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_SAMPLES_H

#include "closed_loop/machine_digs/machine_dig.h"

/// Takes them, with their times and rates, into a dig that holds nothing else yet. It is to be
/// finished (dig_machine_dig_finish()) whatever comes. DIG_EINVAL: fewer than 50. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_machine_samples_take(const struct dig_machine           *machine,
                         const struct dig_machine_recording *recording, struct dig_machine_dig *dig,
                         struct dig_error *error);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_SAMPLES_H
