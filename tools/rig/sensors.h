// Models the sensors: adds their noise and quantises their values.

#ifndef DIG_TOOLS_RIG_SENSORS_H
#define DIG_TOOLS_RIG_SENSORS_H

#include "core/machine.h"
#include "core/sample.h"
#include "tools/rig/motion/track.h"

#include <stdbool.h>
#include <stdint.h>

/// A stream of random numbers: the same seed gives the same stream on every machine.
struct dig_rig_noise {
    uint64_t state;
};

struct dig_rig_noise dig_rig_noise_init(uint64_t seed);

/// Normal deviate of mean 0 and standard deviation 1.
double dig_rig_noise_normal(struct dig_rig_noise *noise);

/// What the sensors read of one row at time_ns: angles with angle_sigma_rad, pressures with their
/// cylinder's pressure_sigma_Pa of normal noise, pitch 0, oil at 45 degC. With a force sensor: the
/// pin's place, the bucket's angle and the sensor's load, each with its sigma. noise NULL: exact.
struct dig_sample dig_rig_sense(const struct dig_machine *machine, const struct dig_rig_row *row,
                                int64_t time_ns, struct dig_rig_noise *noise);

/// Rounds angles and pressures to whole steps of machine->angle_step_rad and pressure_step_Pa, a
/// force sensor's readings to its steps (0: not at all), as a machine recording is to hold them.
void dig_rig_quantise(const struct dig_machine *machine, struct dig_sample *sample);

#endif // DIG_TOOLS_RIG_SENSORS_H
