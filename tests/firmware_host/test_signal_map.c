// Tests for firmware_host/bus/signal_map.c: raw values to SI, by the maps that ship

#include "firmware_host/bus/signal_map.h"

#include "tests/firmware_host/modbus_map.h"

static struct dig_signal_map can_map(void)
{
    struct dig_dbc        dbc;
    struct dig_signal_map map;
    struct dig_error      error = { "" };
    assert_int_equal(dig_dbc_read("config/can/zx200.dbc", &dbc, NULL), DIG_OK);
    if (dig_signal_map_read("config/signals/zx200_can.yaml", &dbc, &map, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    dig_dbc_finish(&dbc);
    return map;
}

// The bytes of the DBC's golden frames, now to SI: 11 MPa is 11e6 Pa; what is not available or
// beyond the range is no number.
TEST(golden_pressure_frame_becomes_pascals)
{
    const struct dig_signal_map map   = can_map();
    const int                   group = dig_signal_map_group(&map, 0x18FF79E8, true);
    assert_true(group >= 0);
    const uint8_t      data[8] = { 0x69, 0x37, 0x32, 0xFF, 0x00, 0xFE, 0xFF, 0xFF };
    struct dig_reading r;
    assert_int_equal(dig_signal_map_frame(&map, (unsigned)group, 8, data, 77, &r), DIG_OK);
    assert_int_equal(r.time_ns, 77);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_HEAD_Pa], DIG_READING_OK);
    assert_close(r.value[DIG_SIGNAL_BOOM_HEAD_Pa], 11e6, 1e-6);
    assert_close(r.value[DIG_SIGNAL_BOOM_ROD_Pa], 1e6, 1e-6);
    assert_close(r.value[DIG_SIGNAL_ARM_HEAD_Pa], 0.0, 1e-6);
    assert_int_equal(r.state[DIG_SIGNAL_ARM_ROD_Pa], DIG_READING_NOT_AVAILABLE);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_HEAD_Pa], DIG_READING_OUT_OF_RANGE); // -10 MPa
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_ROD_Pa], DIG_READING_OUT_OF_RANGE);  // 40.8 MPa
    assert_close(r.value[DIG_SIGNAL_ARM_ROD_Pa], 0.0, 0.0);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_rad], DIG_READING_ABSENT);
    assert_false(r.has_alive);
}

// What SAE J1939-71 sets apart is no value when the map says so, whatever its range allows.
TEST(j1939_s_reserved_values_are_not_available)
{
    struct dig_signal_map map = can_map();
    const unsigned        p   = (unsigned)dig_signal_map_group(&map, 0x18FF79E8, true);
    const unsigned        a   = (unsigned)dig_signal_map_group(&map, 0x18FF7DE8, true);
    const unsigned        t   = (unsigned)dig_signal_map_group(&map, 0x18FF7EE8, true);
    map.j1939                 = true;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        map.entry[i].min           = -1e12;
        map.entry[i].max           = 1e12;
        map.entry[i].not_available = 0;
    }
    struct dig_reading r;
    const uint8_t      pressure[8] = { 0xFA, 0xFB, 0xFC, 0xFD, 0xFE, 0xFF, 0, 0 };
    assert_int_equal(dig_signal_map_frame(&map, p, 8, pressure, 0, &r), DIG_OK);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(r.state[DIG_SIGNAL_BOOM_HEAD_Pa + i],
                         i == 0 ? DIG_READING_OK : DIG_READING_NOT_AVAILABLE);
    }
    const uint8_t angle[8] = { 0xFF, 0xFA, 0x00, 0xFB, 0x12, 0xFE, 0, 0 };
    assert_int_equal(dig_signal_map_frame(&map, a, 8, angle, 0, &r), DIG_OK);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_rad], DIG_READING_OK);
    assert_int_equal(r.state[DIG_SIGNAL_ARM_rad], DIG_READING_NOT_AVAILABLE);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_rad], DIG_READING_NOT_AVAILABLE);
    for (unsigned raw = 0x3FFC; raw <= 0x3FFF; raw++) { // 14 bits
        const uint8_t tilt[8] = { 0, 0, (uint8_t)raw, (uint8_t)(raw >> 8) };
        assert_int_equal(dig_signal_map_frame(&map, t, 8, tilt, 0, &r), DIG_OK);
        assert_int_equal(r.state[DIG_SIGNAL_PITCH_rad],
                         raw < 0x3FFE ? DIG_READING_OK : DIG_READING_NOT_AVAILABLE);
    }
}

TEST(a_frame_with_a_wrong_checksum_is_refused)
{
    struct dig_dbc        dbc;
    struct dig_signal_map map;
    assert_int_equal(dig_dbc_read("tests/data/sealed/zx200_sealed.dbc", &dbc, NULL), DIG_OK);
    assert_int_equal(dig_signal_map_read("tests/data/sealed/signals.yaml", &dbc, &map, NULL),
                     DIG_OK);
    dig_dbc_finish(&dbc);
    const int group = dig_signal_map_group(&map, 0x18FF79E8, true);
    assert_true(group >= 0);
    assert_int_equal(map.group[group].frame.counter_mod, 16);
    assert_close(map.group[group].frame.cycle_s, 0.010, 1e-12);

    // 0xA2: CRC-8 SAE J1850 of 69 37 32 37 32 37 F5, worked out with another program.
    const uint8_t      good[8] = { 0x69, 0x37, 0x32, 0x37, 0x32, 0x37, 0xF5, 0xA2 };
    uint8_t            bad[8];
    struct dig_reading r = { .time_ns = 42 };
    memcpy(bad, good, 8);
    bad[0] ^= 1U;
    assert_int_equal(dig_signal_map_frame(&map, (unsigned)group, 8, bad, 1, &r), DIG_ESTALE);
    assert_int_equal(r.time_ns, 42);
    assert_int_equal(dig_signal_map_frame(&map, (unsigned)group, 8, good, 1, &r), DIG_OK);
    assert_int_equal(r.counter, 5);
    assert_close(r.value[DIG_SIGNAL_BOOM_HEAD_Pa], 11e6, 1e-6);
}

TEST(the_alive_counter_and_the_optional_signals_are_read)
{
    const struct dig_signal_map map     = can_map();
    const unsigned              machine = (unsigned)dig_signal_map_group(&map, 0x18FF84E8, true);
    const unsigned              tilt    = (unsigned)dig_signal_map_group(&map, 0x18FF7EE8, true);
    assert_false(map.group[machine].needed);
    assert_true(map.group[dig_signal_map_group(&map, 0x18FF7DE8, true)].needed);
    assert_int_equal(map.groups, 4);
    assert_close(map.frozen_s, 0.5, 1e-12);

    struct dig_reading r;
    const uint8_t      state_bytes[8] = { 0, 0, 0, 0x91, 0, 0, 0, 0xC8 };
    assert_int_equal(dig_signal_map_frame(&map, machine, 8, state_bytes, 0, &r), DIG_OK);
    assert_true(r.has_alive);
    assert_int_equal(r.alive, 200);
    assert_close(r.value[DIG_SIGNAL_TEMPERATURE_degC], 45.0, 1e-12);

    const uint8_t tilt_bytes[8] = { 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0 }; // 14 ones: not available
    assert_int_equal(dig_signal_map_frame(&map, tilt, 8, tilt_bytes, 0, &r), DIG_OK);
    assert_int_equal(r.state[DIG_SIGNAL_PITCH_rad], DIG_READING_NOT_AVAILABLE);
}

TEST(ids_are_told_apart_and_short_frames_refused)
{
    const struct dig_signal_map map = can_map();
    assert_int_equal(dig_signal_map_group(&map, 0x18FF79E9, true), -1);
    assert_int_equal(dig_signal_map_group(&map, 0x18FF79E8 & 0x7FF, false), -1);
    const uint8_t      data[8] = { 0 };
    struct dig_reading r       = { .time_ns = 42 };
    assert_int_equal(dig_signal_map_frame(&map, 0, 7, data, 1, &r), DIG_EINVAL);
    assert_int_equal(r.time_ns, 42);
}

// Worked by hand: 0x0B28 = 2856 is 0.2856 rad; 0xD724 = -10460 is -1.0460 rad; 8400 is 8.4 MPa.
TEST(golden_register_block_becomes_si)
{
    const struct dig_signal_map map = modbus_map("config/signals/modbus_default.yaml");
    assert_int_equal(map.groups, 1);
    assert_int_equal(map.group[0].function, 4);
    assert_int_equal(map.group[0].first_register, 0);
    assert_int_equal(map.group[0].registers, 12);
    assert_true(map.group[0].needed);
    const uint16_t     block[12] = { 0xFFFF, 0x0B28, 0xD724, 0x8000, 0xFFF6, 8400,
                                     0xFFFF, 60000,  0,      1,      40000,  451 };
    struct dig_reading r;
    dig_signal_map_registers(&map, 0, block, 5, &r);
    assert_true(r.has_alive);
    assert_int_equal(r.alive, 0xFFFF);
    assert_close(r.value[DIG_SIGNAL_BOOM_rad], 0.2856, 1e-12);
    assert_close(r.value[DIG_SIGNAL_ARM_rad], -1.0460, 1e-12);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_rad], DIG_READING_NOT_AVAILABLE);
    assert_close(r.value[DIG_SIGNAL_PITCH_rad], -0.001, 1e-12);
    assert_close(r.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8.4e6, 1e-6);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_ROD_Pa], DIG_READING_NOT_AVAILABLE);
    assert_int_equal(r.state[DIG_SIGNAL_ARM_HEAD_Pa], DIG_READING_OUT_OF_RANGE);
    assert_int_equal(r.state[DIG_SIGNAL_ARM_ROD_Pa], DIG_READING_OK);
    assert_close(r.value[DIG_SIGNAL_BUCKET_ROD_Pa], 40e6, 1e-6);
    assert_close(r.value[DIG_SIGNAL_TEMPERATURE_degC], 45.1, 1e-9);
}

static const char wide_map[] =
    "kind: modbus\n"
    "function: 3\n"
    "low_word_first: true\n"
    "signals:\n"
    "  - {name: boom_rad, register: 10, type: float32, sign: -1, offset: 0.25, min: -2, max: 2}\n"
    "  - {name: arm_rad, register: 12, type: int32, scale: 1e-6, min: -2, max: 2}\n"
    "  - {name: bucket_rad, register: 14, type: int16, scale: 1e-3, min: -2, max: 2}\n" PRESSURES;

// Worked by hand: 0x3F400000 is the float 0.75, so -(0.75 + 0.25) = -1; 0xFFF0BDC0 is -1000000.
TEST(wide_registers_signs_and_offsets_are_applied)
{
    const struct dig_signal_map map = modbus_map(scratch_write("wide.yaml", wide_map));
    assert_int_equal(map.groups, 1);
    assert_int_equal(map.group[0].function, 3);
    assert_int_equal(map.group[0].first_register, 10);
    assert_int_equal(map.group[0].registers, 12);
    uint16_t block[12] = {
        0x0000, 0x3F40, 0xBDC0, 0xFFF0, 500, 0x1200, 0x007A, 1000, 2, 3, 100, 5
    };
    struct dig_reading r;
    dig_signal_map_registers(&map, 0, block, 0, &r);
    assert_close(r.value[DIG_SIGNAL_BOOM_rad], -1.0, 1e-12);
    assert_close(r.value[DIG_SIGNAL_ARM_rad], -1.0, 1e-12);
    assert_close(r.value[DIG_SIGNAL_BUCKET_rad], 0.5, 1e-12);
    assert_close(r.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8000000.0, 1e-6);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_HEAD_Pa], DIG_READING_OK); // 100 * 1e3 - 1e5
    assert_close(r.value[DIG_SIGNAL_BUCKET_HEAD_Pa], 0.0, 1e-6);
    assert_false(r.has_alive);

    block[1] = 0x7FC0; // a float's NaN
    dig_signal_map_registers(&map, 0, block, 0, &r);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_rad], DIG_READING_NAN);
}

TESTS_WITH(scratch_setup, scratch_teardown)
