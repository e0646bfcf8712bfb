#include "firmware_host/bus/checksum.h"

#include <assert.h>

static uint8_t crc8(const uint8_t crc, const uint8_t byte)
{
    unsigned bits = crc ^ byte;
    for (int i = 0; i < 8; i++) {
        bits = (bits & 0x80U) != 0 ? (bits << 1) ^ 0x1DU : bits << 1;
    }
    return (uint8_t)(bits & 0xFFU);
}

static uint8_t tsc1(const size_t bytes, const uint8_t data[], const uint32_t id,
                    const uint64_t counter)
{
    unsigned sum = (unsigned)(counter & 0x0FU);
    for (size_t i = 0; i < bytes && i < 7; i++) {
        sum += data[i];
    }
    for (int shift = 0; shift < 32; shift += 8) {
        sum += (id >> shift) & 0xFFU;
    }
    return (uint8_t)((((sum >> 6) & 0x03U) + (sum >> 3) + sum) & 0x07U);
}

uint8_t dig_checksum_of(const enum dig_checksum kind, const size_t bytes, const uint8_t data[],
                        const size_t at, const uint32_t id, const uint64_t counter)
{
    assert(data != NULL);
    if (kind == DIG_CHECKSUM_J1939_TSC1) {
        return tsc1(bytes, data, id, counter);
    }
    uint8_t sum    = 0;
    uint8_t parity = 0;
    uint8_t crc    = 0xFF;
    for (size_t i = 0; i < bytes; i++) {
        if (i != at) {
            sum    = (uint8_t)(sum + data[i]);
            parity = (uint8_t)(parity ^ data[i]);
            crc    = crc8(crc, data[i]);
        }
    }
    switch (kind) {
    case DIG_CHECKSUM_SUM8: return sum;
    case DIG_CHECKSUM_XOR8: return parity;
    case DIG_CHECKSUM_CRC8_SAE_J1850: return (uint8_t)(crc ^ 0xFFU);
    case DIG_CHECKSUM_J1939_TSC1:
    case DIG_CHECKSUM_NONE: break;
    }
    return 0;
}
