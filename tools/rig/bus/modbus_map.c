#include "tools/rig/bus/modbus_map.h"

#include <math.h>

static uint16_t signed_bits(const struct dig_sample *const sample, const enum dig_signal signal,
                            const double per_bit)
{
    if (!sample->valid[signal] || !isfinite(sample->value[signal])) {
        return 0x8000;
    }
    const double bits = fmin(fmax(round(sample->value[signal] / per_bit), -32767.0), 32767.0);
    return (uint16_t)((int)bits & 0xFFFF);
}

static uint16_t unsigned_bits(const struct dig_sample *const sample, const enum dig_signal signal,
                              const double per_bit)
{
    if (!sample->valid[signal] || !isfinite(sample->value[signal])) {
        return 0xFFFF;
    }
    return (uint16_t)fmin(fmax(round(sample->value[signal] / per_bit), 0.0), 65534.0);
}

void dig_rig_modbus_encode(const struct dig_sample *const sample, const uint16_t alive,
                           uint16_t registers[DIG_RIG_REGISTERS])
{
    registers[0] = alive;
    for (int i = 0; i < 3; i++) {
        registers[1 + i] = signed_bits(sample, (enum dig_signal)(DIG_SIGNAL_BOOM_rad + i), 1e-4);
    }
    registers[4] = signed_bits(sample, DIG_SIGNAL_PITCH_rad, 1e-4);
    for (int i = 0; i < 6; i++) {
        registers[5 + i] =
            unsigned_bits(sample, (enum dig_signal)(DIG_SIGNAL_BOOM_HEAD_Pa + i), 1e3);
    }
    registers[11] = signed_bits(sample, DIG_SIGNAL_TEMPERATURE_degC, 0.1);
    registers[12] = signed_bits(sample, DIG_SIGNAL_PIN_X_m, 2e-5);
    registers[13] = signed_bits(sample, DIG_SIGNAL_PIN_Z_m, 2e-5);
    registers[14] = signed_bits(sample, DIG_SIGNAL_SENSOR_FX_N, 0.01);
    registers[15] = signed_bits(sample, DIG_SIGNAL_SENSOR_FZ_N, 0.01);
    registers[16] = signed_bits(sample, DIG_SIGNAL_SENSOR_MY_Nm, 5e-4);
}
