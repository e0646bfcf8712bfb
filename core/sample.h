// One set of readings of a machine at one instant, and the names its signals go by everywhere:
// in machine recordings, in signal maps, in LCM messages.

#ifndef DIG_CORE_SAMPLE_H
#define DIG_CORE_SAMPLE_H

#include <stdbool.h>
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
    DIG_SIGNALS
};

/// Every signal up to here is needed for a wrench; those after it are optional.
#define DIG_SIGNALS_NEEDED DIG_SIGNAL_PITCH_rad

struct dig_sample {
    int64_t time_ns;            // monotonic, of the youngest signal; any epoch
    double  value[DIG_SIGNALS]; // SI, machine frames of CONTRACT (docs/numerics.md)
    bool    valid[DIG_SIGNALS]; // false: missing, not available or refused; value is then 0
};

/// "boom_rad", "boom_head_Pa", …: the column's name in a machine recording. NULL if out of range.
const char *dig_signal_name(enum dig_signal signal);

/// The signal of that name, or -1.
int dig_signal_find(const char *name);

/// True when every signal a wrench needs is valid.
bool dig_sample_is_complete(const struct dig_sample *sample);

#endif // DIG_CORE_SAMPLE_H
