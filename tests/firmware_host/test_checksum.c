// Tests for firmware_host/bus/checksum.c: published check values, and digrig's own seal, which
// divides polynomials another way.

#include "firmware_host/bus/checksum.h"

#include "tests/testlib.h"
#include "tools/rig/bus/can_layout.h"

#include <string.h>

// The check value every catalogue of CRCs gives for "123456789". The byte the checksum stands in is
// skipped wherever it is.
TEST(crc8_gives_the_published_check_value)
{
    for (size_t at = 0; at <= 9; at++) {
        uint8_t data[10];
        memcpy(data, "123456789", at);
        data[at] = 0xA5;
        memcpy(data + at + 1, &"123456789"[at], 9 - at);
        assert_int_equal(dig_checksum_of(DIG_CHECKSUM_CRC8_SAE_J1850, 10, data, at, 0, 0), 0x4B);
    }
}

// By hand: 1 + 2 + 250 + 9 = 262 = 256 + 6; 1 ^ 2 ^ 250 ^ 9 = 0xF0.
TEST(sums_are_those_of_the_other_bytes)
{
    const uint8_t data[5] = { 1, 2, 250, 77, 9 };
    assert_int_equal(dig_checksum_of(DIG_CHECKSUM_SUM8, 5, data, 3, 0, 0), 6);
    assert_int_equal(dig_checksum_of(DIG_CHECKSUM_XOR8, 5, data, 3, 0, 0), 0xF0);
}

// By hand, a torque command of source 0x0B, id 0x0C00000B: bytes add to 0x01 + 0x00 + 0x7D + 0xFF +
// 0xFF + 0xFF + 0xFF = 0x47A, counter 5, id 0x17: 0x496 = 1174; 1174 >> 6 = 18, & 3 = 2; 1174 >> 3
// = 146; 2 + 146 + 1174 = 1322; & 7 = 2.
TEST(j1939_s_torque_command_is_folded)
{
    const uint8_t data[8] = { 0x01, 0x00, 0x7D, 0xFF, 0xFF, 0xFF, 0xFF, 0x25 };
    assert_int_equal(dig_checksum_of(DIG_CHECKSUM_J1939_TSC1, 8, data, 7, 0x0C00000B, 5), 2);
}

TEST(the_rig_s_seal_is_accepted_and_any_flipped_bit_is_not)
{
    for (unsigned seed = 0; seed < 200; seed++) {
        struct dig_rig_can_frame frame = { .id = 0x18FF79E8 };
        for (unsigned i = 0; i < 6; i++) {
            frame.data[i] = (uint8_t)(seed * 37 + i * i * 91);
        }
        dig_rig_can_seal(&frame, (uint8_t)seed);
        assert_int_equal(frame.data[6], 0xF0 | (seed & 15));
        const uint8_t sum =
            dig_checksum_of(DIG_CHECKSUM_CRC8_SAE_J1850, 8, frame.data, 7, frame.id, 0);
        assert_int_equal(frame.data[7], sum);
        for (unsigned bit = 0; bit < 64; bit++) {
            struct dig_rig_can_frame bad = frame;
            bad.data[bit / 8] ^= (uint8_t)(1U << bit % 8);
            const uint8_t other =
                dig_checksum_of(DIG_CHECKSUM_CRC8_SAE_J1850, 8, bad.data, 7, bad.id, 0);
            assert_int_not_equal(bad.data[7], other);
        }
    }
}
