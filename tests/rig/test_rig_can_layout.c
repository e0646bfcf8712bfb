// Tests for tools/rig/bus/can_layout.c: frames worked out by hand from the layout's table.

#include "tools/rig/bus/can_layout.h"

#include "tests/testlib.h"

#include <stdio.h>
#include <string.h>

static struct dig_sample sample_of(const double boom, const double arm, const double bucket)
{
    struct dig_sample sample = {
        .value = { boom, arm, bucket, 12.4e6, 1.0e6, 0.0, 34.2e6, 0.2e6, 40.0e6, 0.05, 45.0 },
    };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = true;
    }
    return sample;
}

static void assert_frame(const struct dig_rig_can_frame frame, const uint32_t id,
                         const uint8_t data[8])
{
    assert_int_equal(frame.id, id);
    assert_memory_equal(frame.data, data, 8);
}

// (12.4 + 10) / 0.2 = 112 = 0x70; (1 + 10) / 0.2 = 55 = 0x37; 10 / 0.2 = 50 = 0x32;
// 44.2 / 0.2 = 221 = 0xDD; 10.2 / 0.2 = 51 = 0x33; 50 / 0.2 = 250 = 0xFA.
TEST(pressures_are_the_bytes_worked_by_hand)
{
    const struct dig_sample sample  = sample_of(0.0, 0.0, 0.0);
    const uint8_t           bytes[] = { 0x70, 0x37, 0x32, 0xDD, 0x33, 0xFA, 0xFF, 0xFF };
    assert_frame(dig_rig_can_pressures(&sample), 0x18FF79E8, bytes);
}

// (0.5 + 10) / 0.0004 = 26250 = 0x668A; (-1.2 + 10) / 0.0004 = 22000 = 0x55F0;
// (-0.0004 + 10) / 0.0004 = 24999 = 0x61A7. Low byte first.
TEST(angles_are_the_bytes_worked_by_hand)
{
    const struct dig_sample sample  = sample_of(0.5, -1.2, -0.0004);
    const uint8_t           bytes[] = { 0x8A, 0x66, 0xF0, 0x55, 0xA7, 0x61, 0xFF, 0xFF };
    assert_frame(dig_rig_can_angles(&sample), 0x18FF7DE8, bytes);
}

// (0.05 + 4) / 0.0005 = 8100 = 0x1FA4 in fourteen bits, the two above it ones: 0xDFA4.
TEST(tilt_is_the_bytes_worked_by_hand)
{
    const struct dig_sample sample  = sample_of(0.0, 0.0, 0.0);
    const uint8_t           bytes[] = { 0xFF, 0xFF, 0xA4, 0xDF, 0xFF, 0xFF, 0xFF, 0xFF };
    assert_frame(dig_rig_can_tilt(&sample), 0x18FF7EE8, bytes);
}

// 45 + 100 = 145 = 0x91; the counter as it stands.
TEST(state_is_the_bytes_worked_by_hand)
{
    const struct dig_sample sample  = sample_of(0.0, 0.0, 0.0);
    const uint8_t           bytes[] = { 0xFF, 0xFF, 0xFF, 0x91, 0xFF, 0xFF, 0xFF, 0x2A };
    assert_frame(dig_rig_can_state(&sample, 42), 0x18FF84E8, bytes);
}

TEST(what_is_not_known_is_all_ones)
{
    const struct dig_sample none = { .time_ns = 0 };
    uint8_t                 ones[8];
    memset(ones, 0xFF, sizeof ones);
    assert_frame(dig_rig_can_pressures(&none), 0x18FF79E8, ones);
    assert_frame(dig_rig_can_angles(&none), 0x18FF7DE8, ones);
    assert_frame(dig_rig_can_tilt(&none), 0x18FF7EE8, ones);

    struct dig_sample nan              = sample_of(0.0, 0.0, 0.0);
    nan.value[DIG_SIGNAL_BOOM_HEAD_Pa] = NAN;
    nan.value[DIG_SIGNAL_ARM_rad]      = INFINITY;
    assert_int_equal(dig_rig_can_pressures(&nan).data[0], 0xFF);
    assert_int_equal(dig_rig_can_angles(&nan).data[2], 0xFF);
    assert_int_equal(dig_rig_can_angles(&nan).data[3], 0xFF);
}

// A value beyond the field must not read as "not available", nor wrap round to something sensible.
TEST(values_beyond_a_field_stand_at_its_end)
{
    struct dig_sample far              = sample_of(100.0, -100.0, 12.0);
    far.value[DIG_SIGNAL_BOOM_HEAD_Pa] = 60e6;
    far.value[DIG_SIGNAL_BOOM_ROD_Pa]  = -60e6;
    const uint8_t angles[]             = { 0xFE, 0xFF, 0x00, 0x00, 0xD8, 0xD6, 0xFF, 0xFF };
    assert_frame(dig_rig_can_angles(&far), 0x18FF7DE8, angles); // 22 / 0.0004 = 55000 = 0xD6D8
    assert_int_equal(dig_rig_can_pressures(&far).data[0], 0xFE);
    assert_int_equal(dig_rig_can_pressures(&far).data[1], 0x00);
}

// The example of the formats is what candump shows of this sample, oldest frame first.
TEST(example_of_the_formats_is_what_is_sent)
{
    const struct dig_sample        sample   = sample_of(0.5, -1.2, -0.0004);
    const struct dig_rig_can_frame frames[] = { dig_rig_can_angles(&sample),
                                                dig_rig_can_pressures(&sample),
                                                dig_rig_can_tilt(&sample),
                                                dig_rig_can_state(&sample, 42) };
    FILE *const                    file     = fopen("tests/data/formats/rig_can.log", "r");
    assert_non_null(file);
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        char id[16];
        char data[32];
        char expected_id[16];
        char expected_data[32] = "";
        assert_int_equal(fscanf(file, "%*s %*s %15[0-9A-F]#%31[0-9A-F]", id, data), 2);
        (void)snprintf(expected_id, sizeof expected_id, "%08X", (unsigned)frames[i].id);
        for (size_t b = 0; b < 8; b++) {
            (void)snprintf(&expected_data[2 * b], 3, "%02X", (unsigned)frames[i].data[b]);
        }
        assert_string_equal(id, expected_id);
        assert_string_equal(data, expected_data);
    }
    (void)fclose(file);
}
