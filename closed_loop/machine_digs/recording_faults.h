// What a recording of a machine may have wrong, so that whoever takes it is told a bucket of
// another gravel: a joint that is elsewhere from one sample to the next (recordings put together in
// one file, or a sensor that lost its zero), pressures in another unit or of dead sensors, and
// pressures that a sensor or a relief valve cut off.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_RECORDING_FAULTS_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_RECORDING_FAULTS_H

#include "core/machine.h"
#include "core/recording.h"
#include "core/sample.h"

#include <stdbool.h>
#include <stddef.h>

struct dig_pose_jump {
    size_t          before; // the last sample before it
    enum dig_signal signal;
    double          rad;
};

/// True when an angle stays at least .1 rad beyond what 3 rad/s bring it. One wrong sample is no
/// jump. All samples have all angles, in time. *jump is the first; it is untouched otherwise.
bool dig_pose_jump_find(size_t samples, const struct dig_sample sample[],
                        struct dig_pose_jump *jump);

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

struct dig_clip {
    enum dig_signal signal;
    double          limit_Pa; // where it ends
    double          time_s;   // how long it stands there, in all
};

/// log10 of the chance that noise makes a chamber's readings stand at their own highest value as
/// often in a row as they do: readings * share^(longest run - 1), share being how often a reading
/// repeats the one before below the highest value. A load that comes and goes is at its highest for
/// a moment, and noise moves it from reading to reading. 0 where noise does not show through the
/// sensor's steps (share above .7, or as long a run elsewhere), and at most 0.
double dig_saturation_log10_chance(const struct dig_machine_recording *recording,
                                   enum dig_signal                     signal);

/// True when a chamber's pressure was cut off at its own highest value: that chance is below a
/// thousandth, or it stands there for a second or more, ten times as long as just below (within a
/// step as the readings make there, or 1 %) and above three times the return side's pressure, where
/// a chamber may well be constant. *clip tells the worst; it is untouched otherwise. O(rows).
bool dig_saturation_find(const struct dig_machine           *machine,
                         const struct dig_machine_recording *recording, struct dig_clip *clip);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_RECORDING_FAULTS_H
