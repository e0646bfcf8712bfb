// What sensors scatter by, told by what they read. Noise that moves more slowly than the readings
// come is not seen here: verdict/trace_noise.c.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
#define DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H

#include "core/machine.h"
#include "core/recording.h"

/// One sigma of the white noise in each of so many rows of a signal, which puts a reading and the
/// next off the line through those beside them to either side; what moves more slowly, as grains
/// that cross a blade do, does not. Rows that repeat the one before count as one reading: what it
/// is off by averages the less.
double dig_reading_noise(size_t rows, const double value[]);

/// Raises the machine's pressure_sigma_Pa and angle_sigma_rad to what the recordings show, where
/// that is clearly more than the file says: the rms of how readings differ from the mean of both
/// beside them.
void dig_reading_noise_raise(struct dig_machine *machine, size_t digs,
                             const struct dig_machine_recording recording[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
