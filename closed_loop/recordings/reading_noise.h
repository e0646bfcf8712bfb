// White noise of sensors, estimated from their readings. Noise that is slower than the readings is
// not seen here: closed_loop/verdict/trace_work.c.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
#define DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H

#include "core/machine.h"
#include "core/recording.h"

/// 1 sigma of the white noise in one row of a signal, in the signal's unit. With e_i the distance
/// of a reading from the line through both beside it, white noise gives neighbouring e opposite
/// signs, sigma^2 = -mean(e_i e_(i+1)). Slower motion, as of grains that cross a blade, does not.
/// Rows that repeat the one before count as one reading, so the noise averages out less.
double dig_reading_noise(size_t rows, const double value[]);

/// Raises the machine's pressure_sigma_Pa and angle_sigma_rad to what the recordings show, where
/// that is clearly more: the rms distance of a reading from the mean of both beside it.
void dig_reading_noise_raise(struct dig_machine *machine, size_t digs,
                             const struct dig_machine_recording recording[]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_READING_NOISE_H
