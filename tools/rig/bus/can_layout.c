#include "tools/rig/bus/can_layout.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

// A signal in whole bits, not_available when it is not valid, one less where it does not fit.
static unsigned raw_of(const struct dig_sample *const sample, const enum dig_signal signal,
                       const double per_bit, const double offset, const unsigned not_available)
{
    if (!sample->valid[signal] || !isfinite(sample->value[signal])) {
        return not_available;
    }
    const double bits = round((sample->value[signal] - offset) / per_bit);
    return (unsigned)fmin(fmax(bits, 0.0), (double)(not_available - 1));
}

static struct dig_rig_can_frame blank(const uint32_t id)
{
    struct dig_rig_can_frame frame = { .id = id };
    memset(frame.data, 0xFF, sizeof frame.data);
    return frame;
}

static void put_le(uint8_t at[2], const unsigned raw)
{
    at[0] = (uint8_t)(raw & 0xFFU);
    at[1] = (uint8_t)(raw >> 8);
}

struct dig_rig_can_frame dig_rig_can_pressures(const struct dig_sample *const sample)
{
    struct dig_rig_can_frame frame = blank(0x18FF79E8);
    for (int i = 0; i < 6; i++) {
        const enum dig_signal signal = (enum dig_signal)(DIG_SIGNAL_BOOM_HEAD_Pa + i);
        frame.data[i]                = (uint8_t)raw_of(sample, signal, 0.2e6, -10e6, 0xFF);
    }
    return frame;
}

struct dig_rig_can_frame dig_rig_can_angles(const struct dig_sample *const sample)
{
    struct dig_rig_can_frame frame = blank(0x18FF7DE8);
    for (size_t i = 0; i < 3; i++) {
        const enum dig_signal signal = (enum dig_signal)(DIG_SIGNAL_BOOM_rad + i);
        put_le(&frame.data[2 * i], raw_of(sample, signal, 0.0004, -10.0, 0xFFFF));
    }
    return frame;
}

struct dig_rig_can_frame dig_rig_can_tilt(const struct dig_sample *const sample)
{
    struct dig_rig_can_frame frame = blank(0x18FF7EE8);
    // Fourteen bits of the second word; its two upper bits belong to nobody and stay ones.
    put_le(frame.data + 2, 0xC000U | raw_of(sample, DIG_SIGNAL_PITCH_rad, 0.0005, -4.0, 0x3FFF));
    return frame;
}

struct dig_rig_can_frame dig_rig_can_state(const struct dig_sample *const sample,
                                           const uint8_t                  alive)
{
    struct dig_rig_can_frame frame = blank(0x18FF84E8);
    frame.data[3] = (uint8_t)raw_of(sample, DIG_SIGNAL_TEMPERATURE_degC, 1.0, -100.0, 0xFF);
    frame.data[7] = alive;
    return frame;
}

// Long division of the message, followed by eight zero bits, by x^8 + x^4 + x^3 + x^2 + 1; its
// first byte inverted and the remainder inverted, as SAE J1850 has it.
static uint8_t remainder_of(const uint8_t data[7])
{
    uint8_t padded[8] = { 0 };
    memcpy(padded, data, 7);
    padded[0]       = (uint8_t)~padded[0];
    unsigned window = padded[0];
    for (unsigned bit = 8; bit < 64; bit++) {
        const unsigned next  = ((unsigned)padded[bit / 8] >> (7 - bit % 8)) & 1U;
        const bool     carry = (window & 0x80U) != 0;
        window               = ((window << 1) | next) & 0xFFU;
        window ^= carry ? 0x1DU : 0U;
    }
    return (uint8_t)~window;
}

void dig_rig_can_seal(struct dig_rig_can_frame *const frame, const uint8_t counter)
{
    frame->data[6] = (uint8_t)(0xF0U | (counter & 0x0FU));
    frame->data[7] = remainder_of(frame->data);
}
