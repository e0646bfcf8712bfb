// What a machine's sensors scatter by, told by what they read.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
#define DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H

#include "core/machine.h"
#include "core/recording.h"

/// Raises the machine's pressure_sigma_Pa and angle_sigma_rad to what the recordings show, where
/// that is clearly more than the file says: the rms of how readings differ from the mean of both
/// beside them. Noise that moves more slowly than the samples is not seen so.
void dig_reading_noise_raise(struct dig_machine *machine, size_t digs,
                             const struct dig_machine_recording recording[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
