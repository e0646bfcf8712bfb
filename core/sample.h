// One set of readings of a machine at one instant, and the names its signals go by everywhere:
// in machine recordings, in signal maps, in LCM messages.

#ifndef DIG_CORE_SAMPLE_H
#define DIG_CORE_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// The order is that of a machine recording's columns and never changes.
enum dig_signal {
    DIG_SIGNAL_BOOM_rad,
    DIG_SIGNAL_ARM_rad,
    DIG_SIGNAL_BUCKET_rad,
    DIG_SIGNAL_BOOM_HEAD_Pa,
    DIG_SIGNAL_BOOM_ROD_Pa,
    DIG_SIGNAL_ARM_HEAD_Pa,
    DIG_SIGNAL_ARM_ROD_Pa,
    DIG_SIGNAL_BUCKET_HEAD_Pa,
    DIG_SIGNAL_BUCKET_ROD_Pa,
    DIG_SIGNAL_PITCH_rad,
    DIG_SIGNAL_TEMPERATURE_degC,
    // Of a rig that carries its bucket on a force sensor (core/machine.h), beside bucket_rad.
    DIG_SIGNAL_PIN_X_m,
    DIG_SIGNAL_PIN_Z_m,
    DIG_SIGNAL_SENSOR_FX_N,
    DIG_SIGNAL_SENSOR_FZ_N,
    DIG_SIGNAL_SENSOR_MY_Nm,
    DIG_SIGNALS
};

/// Every signal up to here is needed for force and moment of a machine with cylinders.
#define DIG_SIGNALS_NEEDED DIG_SIGNAL_PITCH_rad

/// Where force and moment come from: a machine's cylinders, or a rig's force sensor.
enum dig_sensing { DIG_SENSING_CYLINDERS, DIG_SENSING_SENSOR };

/// Room for the names of all of those.
#define DIG_SIGNAL_NAMES_SIZE 160

struct dig_sample {
    int64_t time_ns;            // monotonic, of the youngest signal; any epoch
    double  value[DIG_SIGNALS]; // SI, in the machine's frames (docs/architecture.md)
    bool    valid[DIG_SIGNALS]; // false: missing, not available or refused; value is then 0
};

/// "boom_rad", "boom_head_Pa", …: the column's name in a machine recording. NULL if out of range.
const char *dig_signal_name(enum dig_signal signal);

/// The signal of that name, or -1.
int dig_signal_find(const char *name);

/// Of which kind signals are: by sensor, where some are there that only a force sensor's rig has,
/// and none that only a machine with cylinders has.
enum dig_sensing dig_signals_sensing(const bool valid[DIG_SIGNALS]);

/// True for what force and moment need: the three angles and all pressures; with a force sensor the
/// pin's place, the bucket's angle and all that the sensor reads.
bool dig_signal_is_needed(enum dig_sensing sensing, enum dig_signal signal);

/// True for what the moment needs: the three angles and the bucket's pressures. The other
/// cylinders' pressures give the force. With a force sensor all that is needed.
bool dig_signal_gives_moment(enum dig_sensing sensing, enum dig_signal signal);

/// True for what can always be done without: pitch and temperature.
bool dig_signal_is_optional(enum dig_signal signal);

/// True when every signal the moment needs is valid.
bool dig_sample_has_moment(const struct dig_sample *sample);

/// True when every signal force and moment need is valid.
bool dig_sample_is_complete(const struct dig_sample *sample);

/// Writes the names of those signals among the needed that are not valid, "boom_head_Pa, …", cut to
/// size; "" when none is missing.
void dig_signal_name_missing(const bool valid[DIG_SIGNALS], size_t size, char text[]);

#endif // DIG_CORE_SAMPLE_H
