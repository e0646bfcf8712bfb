#include "core/sample.h"

#include "core/text.h"

#include <assert.h>
#include <string.h>

static const char *const names[DIG_SIGNALS] = {
    [DIG_SIGNAL_BOOM_rad]         = "boom_rad",
    [DIG_SIGNAL_ARM_rad]          = "arm_rad",
    [DIG_SIGNAL_BUCKET_rad]       = "bucket_rad",
    [DIG_SIGNAL_BOOM_HEAD_Pa]     = "boom_head_Pa",
    [DIG_SIGNAL_BOOM_ROD_Pa]      = "boom_rod_Pa",
    [DIG_SIGNAL_ARM_HEAD_Pa]      = "arm_head_Pa",
    [DIG_SIGNAL_ARM_ROD_Pa]       = "arm_rod_Pa",
    [DIG_SIGNAL_BUCKET_HEAD_Pa]   = "bucket_head_Pa",
    [DIG_SIGNAL_BUCKET_ROD_Pa]    = "bucket_rod_Pa",
    [DIG_SIGNAL_PITCH_rad]        = "pitch_rad",
    [DIG_SIGNAL_TEMPERATURE_degC] = "temperature_degC",
    [DIG_SIGNAL_PIN_X_m]          = "pin_X_m",
    [DIG_SIGNAL_PIN_Z_m]          = "pin_Z_m",
    [DIG_SIGNAL_SENSOR_FX_N]      = "sensor_Fx_N",
    [DIG_SIGNAL_SENSOR_FZ_N]      = "sensor_Fz_N",
    [DIG_SIGNAL_SENSOR_MY_Nm]     = "sensor_My_Nm",
};

const char *dig_signal_name(const enum dig_signal signal)
{
    return (signal >= 0 && signal < DIG_SIGNALS) ? names[signal] : NULL;
}

int dig_signal_find(const char *const name)
{
    assert(name != NULL);
    for (int i = 0; i < DIG_SIGNALS; i++) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

enum dig_sensing dig_signals_sensing(const bool valid[const DIG_SIGNALS])
{
    assert(valid != NULL);
    bool by_sensor    = false;
    bool by_cylinders = false;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        by_sensor = by_sensor || (valid[i] && i >= DIG_SIGNAL_PIN_X_m);
        by_cylinders =
            by_cylinders || (valid[i] && i < DIG_SIGNALS_NEEDED && i != DIG_SIGNAL_BUCKET_rad);
    }
    return by_sensor && !by_cylinders ? DIG_SENSING_SENSOR : DIG_SENSING_CYLINDERS;
}

bool dig_signal_is_optional(const enum dig_signal signal)
{
    return signal == DIG_SIGNAL_PITCH_rad || signal == DIG_SIGNAL_TEMPERATURE_degC;
}

bool dig_signal_is_needed(const enum dig_sensing sensing, const enum dig_signal signal)
{
    return sensing == DIG_SENSING_CYLINDERS
               ? signal < DIG_SIGNALS_NEEDED
               : signal == DIG_SIGNAL_BUCKET_rad || signal >= DIG_SIGNAL_PIN_X_m;
}

bool dig_signal_gives_moment(const enum dig_sensing sensing, const enum dig_signal signal)
{
    const bool of_others = signal >= DIG_SIGNAL_BOOM_HEAD_Pa && signal <= DIG_SIGNAL_ARM_ROD_Pa;
    return dig_signal_is_needed(sensing, signal) && !of_others;
}

// Whether all signals that are wanted are valid.
static bool has_all(const struct dig_sample *const sample,
                    bool (*const is_wanted)(enum dig_sensing, enum dig_signal))
{
    assert(sample != NULL);
    const enum dig_sensing sensing = dig_signals_sensing(sample->valid);
    bool                   has     = true;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        has = has && (sample->valid[i] || !is_wanted(sensing, (enum dig_signal)i));
    }
    return has;
}

bool dig_sample_has_moment(const struct dig_sample *const sample)
{
    return has_all(sample, dig_signal_gives_moment);
}

bool dig_sample_is_complete(const struct dig_sample *const sample)
{
    return has_all(sample, dig_signal_is_needed);
}

void dig_signal_name_missing(const bool valid[const DIG_SIGNALS], const size_t size,
                             char text[const])
{
    assert(valid != NULL && size > 0 && text != NULL);
    const enum dig_sensing sensing = dig_signals_sensing(valid);
    text[0]                        = '\0';
    for (int i = 0; i < DIG_SIGNALS; i++) {
        if (!valid[i] && dig_signal_is_needed(sensing, (enum dig_signal)i)) {
            dig_text_list(size, text, names[i]);
        }
    }
}
