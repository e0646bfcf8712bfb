// A signal's value in a frame: one half of firmware_host/bus/dbc.h.

#include "firmware_host/bus/dbc.h"

uint64_t dig_dbc_raw(const struct dig_dbc_signal *const signal, const uint8_t data[])
{
    uint64_t raw = 0;
    unsigned bit = signal->start_bit;
    for (unsigned i = 0; i < signal->bits; i++) {
        const uint64_t value = ((unsigned)data[bit / 8] >> (bit % 8)) & 1U;
        if (signal->intel) {
            raw |= value << i;
            bit++;
        } else {
            raw = (raw << 1) | value;
            bit = bit % 8 == 0 ? bit + 15 : bit - 1;
        }
    }
    return raw;
}

double dig_dbc_value(const struct dig_dbc_signal *const signal, const uint64_t raw)
{
    if (!signal->is_signed) {
        return signal->factor * (double)raw + signal->offset;
    }
    // Two's complement, the magnitude of a negative value taken in whole numbers: a double has 53
    // bits.
    const uint64_t top   = UINT64_C(1) << (signal->bits - 1);
    const uint64_t below = ~raw & (top | (top - 1));
    const double   value = (raw & top) != 0 ? -(double)(below + 1) : (double)raw;
    return signal->factor * value + signal->offset;
}
