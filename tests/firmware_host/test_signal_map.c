// Tests for firmware_host/bus/signal_map.c and firmware_host/config/config_map.c

#include "firmware_host/bus/signal_map.h"

#include "tests/scratch.h"

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

static struct dig_signal_map modbus_map(const char *const path)
{
    struct dig_signal_map map;
    struct dig_error      error = { "" };
    if (dig_signal_map_read(path, NULL, &map, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return map;
}

// The bytes of the DBC's golden frames, now to SI: 11 MPa is 11e6 Pa; what is not available or
// beyond the range is no number.
static void golden_pressure_frame_becomes_pascals(void **state)
{
    (void)state;
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
static void j1939_s_reserved_values_are_not_available(void **state)
{
    (void)state;
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

static void a_frame_with_a_wrong_checksum_is_refused(void **state)
{
    (void)state;
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

static void the_alive_counter_and_the_optional_signals_are_read(void **state)
{
    (void)state;
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

static void ids_are_told_apart_and_short_frames_refused(void **state)
{
    (void)state;
    const struct dig_signal_map map = can_map();
    assert_int_equal(dig_signal_map_group(&map, 0x18FF79E9, true), -1);
    assert_int_equal(dig_signal_map_group(&map, 0x18FF79E8 & 0x7FF, false), -1);
    const uint8_t      data[8] = { 0 };
    struct dig_reading r       = { .time_ns = 42 };
    assert_int_equal(dig_signal_map_frame(&map, 0, 7, data, 1, &r), DIG_EINVAL);
    assert_int_equal(r.time_ns, 42);
}

// Worked by hand: 0x0B28 = 2856 is 0.2856 rad; 0xD724 = -10460 is -1.0460 rad; 8400 is 8.4 MPa.
static void golden_register_block_becomes_si(void **state)
{
    (void)state;
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

#define PRESSURES                                                                                  \
    "  - {name: boom_head_Pa, register: 15, type: uint32, min: 0, max: 4.0e7}\n"                   \
    "  - {name: boom_rod_Pa, register: 17, scale: 1e3, min: 0, max: 4.0e7}\n"                      \
    "  - {name: arm_head_Pa, register: 18, scale: 1e3, min: 0, max: 4.0e7}\n"                      \
    "  - {name: arm_rod_Pa, register: 19, scale: 1e3, min: 0, max: 4.0e7}\n"                       \
    "  - {name: bucket_head_Pa, register: 20, scale: 1e3, offset: -1.0e5, min: -1, max: 4.0e7}\n"  \
    "  - {name: bucket_rod_Pa, register: 21, scale: 1e3, min: 0, max: 4.0e7}\n"

static const char wide_map[] =
    "kind: modbus\n"
    "function: 3\n"
    "low_word_first: true\n"
    "signals:\n"
    "  - {name: boom_rad, register: 10, type: float32, sign: -1, offset: 0.25, min: -2, max: 2}\n"
    "  - {name: arm_rad, register: 12, type: int32, scale: 1e-6, min: -2, max: 2}\n"
    "  - {name: bucket_rad, register: 14, type: int16, scale: 1e-3, min: -2, max: 2}\n" PRESSURES;

// Worked by hand: 0x3F400000 is the float 0.75, so -(0.75 + 0.25) = -1; 0xFFF0BDC0 is -1000000.
static void wide_registers_signs_and_offsets_are_applied(void **state)
{
    (void)state;
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

#define BARE                                                                                       \
    "kind: modbus\nsignals:\n"                                                                     \
    "  - {name: boom_rad, register: 1, min: -2, max: 2}\n"                                         \
    "  - {name: arm_rad, register: 2, min: -2, max: 2}\n"                                          \
    "  - {name: bucket_rad, register: 3, min: -2, max: 2}\n"                                       \
    "  - {name: bucket_head_Pa, register: 4, min: 0, max: 4.0e7}\n"

static void a_machine_with_the_buckets_pressures_alone_can_be_mapped(void **state)
{
    (void)state;
    static const char rod[] = "  - {name: bucket_rod_Pa, register: 5, min: 0, max: 4.0e7}\n";
    char              text[1024];
    (void)snprintf(text, sizeof text, BARE "%s", rod);
    const struct dig_signal_map map = modbus_map(scratch_write("bucket.yaml", text));
    assert_true(map.entry[DIG_SIGNAL_BUCKET_ROD_Pa].used);
    assert_false(map.entry[DIG_SIGNAL_BOOM_HEAD_Pa].used);
    const uint16_t     block[] = { 1, 1, 1, 5000, 6000 };
    struct dig_reading r;
    dig_signal_map_registers(&map, 0, block, 5, &r);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_ROD_Pa], DIG_READING_OK);
    assert_int_equal(r.state[DIG_SIGNAL_ARM_ROD_Pa], DIG_READING_ABSENT);

    struct dig_signal_map none  = { .groups = 42 };
    struct dig_error      error = { "" };
    assert_int_equal(dig_signal_map_read(scratch_write("bad.yaml", BARE), NULL, &none, &error),
                     DIG_EINVAL);
    assert_non_null(strstr(error.text, "no entry bucket_rod_Pa"));
    (void)snprintf(text, sizeof text,
                   BARE "%s  - {name: arm_rod_Pa, register: 6, min: 0, max: 4.0e7}\n", rod);
    assert_int_equal(dig_signal_map_read(scratch_write("bad.yaml", text), NULL, &none, &error),
                     DIG_EINVAL);
    assert_non_null(strstr(error.text, "no entry arm_head_Pa, expected both"));
    assert_int_equal(none.groups, 42);
}

// A rig's: the pin's place in millimetres, the sensor in newtons, each register signed.
static void a_rig_with_a_force_sensor_can_be_mapped(void **state)
{
    (void)state;
    static const char text[] =
        "kind: modbus\nsignals:\n"
        "  - {name: bucket_rad,   register: 0, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: pin_X_m,      register: 1, type: int16, scale: 1e-4, sign: -1, min: -1, max: "
        "1}\n"
        "  - {name: pin_Z_m,      register: 2, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: sensor_Fx_N,  register: 3, type: int16, scale: 0.01, min: -300, max: 300}\n"
        "  - {name: sensor_Fz_N,  register: 4, type: int16, scale: 0.01, min: -300, max: 300}\n"
        "  - {name: sensor_My_Nm, register: 5, type: int16, scale: 1e-3, min: -10, max: 10}\n";
    const struct dig_signal_map map = modbus_map(scratch_write("sensor.yaml", text));
    assert_int_equal(dig_signal_map_sensing(&map), DIG_SENSING_SENSOR);
    assert_true(map.group[0].needed && !map.group[0].dispensable);
    const uint16_t     registers[] = { 0xCE14, 833, 1719, 125, 0xFFDB, 27 };
    struct dig_reading r;
    dig_signal_map_registers(&map, 0, registers, 7, &r);
    assert_close(r.value[DIG_SIGNAL_BUCKET_rad], -1.278, 1e-12);
    assert_close(r.value[DIG_SIGNAL_PIN_X_m], -0.0833, 1e-12);
    assert_close(r.value[DIG_SIGNAL_PIN_Z_m], 0.1719, 1e-12);
    assert_close(r.value[DIG_SIGNAL_SENSOR_FX_N], 1.25, 1e-12);
    assert_close(r.value[DIG_SIGNAL_SENSOR_FZ_N], -0.37, 1e-12);
    assert_close(r.value[DIG_SIGNAL_SENSOR_MY_Nm], 0.027, 1e-12);

    const struct dig_signal_map ours = modbus_map("config/signals/modbus_sensor.yaml");
    assert_int_equal(dig_signal_map_sensing(&ours), DIG_SENSING_SENSOR);
    assert_int_equal(ours.group[0].registers, 17);

    struct dig_error      error = { "" };
    struct dig_signal_map none;
    char                  bad[1024];
    (void)snprintf(bad, sizeof bad, "%.*s", (int)(strstr(text, "  - {name: sensor_My") - text),
                   text);
    assert_int_equal(dig_signal_map_read(scratch_write("bad.yaml", bad), NULL, &none, &error),
                     DIG_EINVAL);
    assert_contains(error.text, "no entry sensor_My_Nm, expected the pin's place");
}

static void defects_are_refused_with_file_line_and_key(void **state)
{
    (void)state;
    static const char angles[] =
        "  - {name: arm_rad, register: 12, min: -2, max: 2}\n"
        "  - {name: bucket_rad, register: 14, min: -2, max: 2}\n" PRESSURES;
    static const struct {
        const char *head, *expected;
    } cases[] = {
        { "kind: modbus\nsignals:\n  - {name: boom_deg, register: 1, min: 0, max: 1}\n",
          "bad.yaml:3: signals[0].name: \"boom_deg\", expected" },
        { "kind: modbus\nsignals:\n  - {name: arm_rad, register: 1, min: 0, max: 1}\n",
          "bad.yaml:4: signals[1].name: \"arm_rad\" again" },
        { "kind: modbus\nsignals:\n  - {name: boom_rad, min: 0, max: 1}\n",
          "bad.yaml:3: signals[0].register: missing" },
        { "kind: modbus\nsignals:\n  - {name: boom_rad, register: 1, min: 1, max: 1}\n",
          "bad.yaml:3: signals[0].max: 1, expected more than min" },
        { "kind: modbus\nsignals:\n  - {name: boom_rad, register: 1, sign: 2, min: 0, max: 1}\n",
          "bad.yaml:3: signals[0].sign: 2, expected 1 or -1" },
        { "kind: modbus\nsignals:\n  - {name: boom_rad, register: 65536, min: 0, max: 1}\n",
          "bad.yaml:3: signals[0].register: 65536, expected 0" },
        { "kind: modbus\nblocks: [{register: 0, registers: 13}]\nsignals:\n"
          "  - {name: boom_rad, register: 900, min: 0, max: 1}\n",
          "bad.yaml:4: signals[0].register: 900, expected it within one of the blocks" },
        { "kind: modbus\nblocks: [{register: 10, registers: 6}, {register: 1, registers: 1}]\n"
          "signals:\n  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "signals[3].register: 15, expected it within" }, // its second word is not
        { "kind: modbus\nalive: {register: 9}\nblocks: [{register: 10, registers: 20}]\n"
          "signals:\n  - {name: boom_rad, register: 10, min: 0, max: 1}\n",
          "alive.register: 9, expected it within one of the blocks" },
        { "kind: modbus\nblocks: [{register: 0, registers: 126}]\nsignals:\n"
          "  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "bad.yaml:2: blocks[0].registers: 126, expected 1 … 125" },
        { "kind: modbus\nblocks: [{register: 65530, registers: 7}]\nsignals:\n"
          "  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "blocks[0].registers: 7, expected 1 … 6" },
        { "kind: modbus\nblocks: [{register: 1, registers: 7, function: 6}]\nsignals:\n"
          "  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "blocks[0].function: 6, expected 3 … 4" },
        { "kind: modbus\nblocks: [{register: 1, registers: 7, poll_Hz: -1}]\nsignals:\n"
          "  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "blocks[0].poll_Hz: -1, expected 0.01 … 1000" },
        { "kind: modbus\nfunction: 6\nsignals:\n  - {name: boom_rad, register: 1, min: 0, max: "
          "1}\n",
          "bad.yaml:2: function: 6, expected 4" },
        { "kind: modbus\nalive: {register: 0, frozen_ms: -1}\nsignals:\n"
          "  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "bad.yaml:2: alive.frozen_ms: -1" },
        { "kind: modbus\nsignals:\n", "signals: no entry boom_rad" },
        { "kind: can\nsignals:\n  - {name: boom_rad, register: 1, min: 0, max: 1}\n",
          "bad.yaml:1: kind: can, expected modbus" },
        { "kind: modbus\nsignals:\n  - {name: boom_rad, register: 1, max: 1}\n",
          "signals[0].min: missing" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[2048];
        (void)snprintf(text, sizeof text, "%s%s", cases[i].head, angles);
        struct dig_signal_map map   = { .groups = 42 };
        struct dig_error      error = { "" };
        assert_int_equal(dig_signal_map_read(scratch_write("bad.yaml", text), NULL, &map, &error),
                         DIG_EINVAL);
        if (strstr(error.text, cases[i].expected) == NULL) {
            fail_msg("case %zu: \"%s\" lacks \"%s\"", i, error.text, cases[i].expected);
        }
        assert_int_equal(map.groups, 42);
    }
}

// What carries nothing but the force can be done without.
static void a_block_of_force_alone_is_spared(void **state)
{
    (void)state;
    static const char           text[] = "kind: modbus\n"
                                         "blocks:\n"
                                         "  - {register: 0, registers: 4}\n"
                                         "  - {register: 10, registers: 2}\n"
                                         "  - {register: 20, registers: 3}\n"
                                         "  - {register: 30, registers: 1}\n"
                                         "signals:\n"
                                         "  - {name: boom_rad, register: 0, min: -2, max: 2}\n"
                                         "  - {name: arm_rad, register: 1, min: -2, max: 2}\n"
                                         "  - {name: bucket_rad, register: 2, min: -2, max: 2}\n"
                                         "  - {name: bucket_head_Pa, register: 3, min: 0, max: 4.0e7}\n"
                                         "  - {name: boom_head_Pa, register: 10, min: 0, max: 4.0e7}\n"
                                         "  - {name: boom_rod_Pa, register: 11, min: 0, max: 4.0e7}\n"
                                         "  - {name: arm_head_Pa, register: 20, min: 0, max: 4.0e7}\n"
                                         "  - {name: arm_rod_Pa, register: 21, min: 0, max: 4.0e7}\n"
                                         "  - {name: bucket_rod_Pa, register: 22, min: 0, max: 4.0e7}\n"
                                         "  - {name: pitch_rad, register: 30, min: -2, max: 2}\n";
    const struct dig_signal_map map    = modbus_map(scratch_write("spared.yaml", text));
    assert_int_equal(map.groups, 4);
    for (size_t g = 0; g < 4; g++) {
        assert_int_equal(map.group[g].needed, g < 3);
        assert_int_equal(map.group[g].dispensable, g == 1); // the arm's come with the bucket's
    }
}

// Registers far apart are asked for in as few requests as need be, or as the map says.
static void registers_far_apart_come_in_blocks(void **state)
{
    (void)state;
    static const char far[] =
        "kind: modbus\n%s"
        "alive: {register: 4000}\n"
        "signals:\n"
        "  - {name: pitch_rad, register: 900, min: -2, max: 2}\n"
        "  - {name: arm_rad, register: 12, min: -2, max: 2}\n"
        "  - {name: boom_rad, register: 10, min: -2, max: 2}\n"
        "  - {name: bucket_rad, register: 136, min: -2, max: 2}\n"
        "  - {name: bucket_head_Pa, register: 134, min: -1, max: 4.0e7}\n"
        "  - {name: bucket_rod_Pa, register: 133, type: uint32, min: 0, max: 4.0e9}\n";
    char text[1024];
    (void)snprintf(text, sizeof text, far, "");
    // 10 … 134 is one request and no more.
    const struct dig_signal_map made = modbus_map(scratch_write("far.yaml", text));
    assert_int_equal(made.groups, 4);
    static const struct {
        unsigned first, registers;
        bool     needed;
    } expected[] = { { 10, 125, true }, { 136, 1, true }, { 900, 1, false }, { 4000, 1, false } };
    for (size_t g = 0; g < made.groups; g++) {
        assert_int_equal(made.group[g].first_register, expected[g].first);
        assert_int_equal(made.group[g].registers, expected[g].registers);
        assert_int_equal(made.group[g].needed, expected[g].needed);
        assert_int_equal(made.group[g].function, 4);
    }
    assert_int_equal(made.alive.group, 3);

    (void)snprintf(text, sizeof text, far,
                   "blocks:\n"
                   "  - {register: 4000, registers: 2, poll_Hz: 5, function: 3, delay_ms: 20}\n"
                   "  - {register: 10, registers: 3}\n"
                   "  - {register: 130, registers: 10, poll_Hz: 50}\n"
                   "  - {register: 900, registers: 1, poll_Hz: 1}\n");
    const struct dig_signal_map named = modbus_map(scratch_write("far.yaml", text));
    assert_int_equal(named.groups, 4);
    assert_int_equal(named.group[0].function, 3);
    assert_int_equal(named.group[1].function, 4);
    assert_close(named.group[0].poll_s, 0.2, 1e-12);
    assert_close(named.group[0].frame.delay_s, 0.02, 1e-12);
    assert_close(named.group[1].poll_s, 0.0, 0.0);
    assert_true(named.group[1].needed && named.group[2].needed);
    assert_false(named.group[0].needed || named.group[3].needed);
    assert_false(named.group[1].dispensable || named.group[2].dispensable ||
                 named.group[3].dispensable);

    uint16_t           block[10] = { [3] = 1, [4] = 2, [6] = 1 };
    struct dig_reading r;
    dig_signal_map_registers(&named, 2, block, 7, &r);
    assert_int_equal(r.group, 2);
    assert_close(r.value[DIG_SIGNAL_BUCKET_ROD_Pa], 65538.0, 0.0);
    assert_close(r.value[DIG_SIGNAL_BUCKET_rad], 1.0, 0.0);
    assert_int_equal(r.state[DIG_SIGNAL_BOOM_rad], DIG_READING_ABSENT);
    assert_false(r.has_alive);
    dig_signal_map_registers(&named, 0, block, 7, &r);
    assert_true(r.has_alive);
    assert_int_equal(r.state[DIG_SIGNAL_BUCKET_rad], DIG_READING_ABSENT);
}

// A CAN map with one thing wrong in its first entry.
static void check_can(const char *const entry, const char *const expected)
{
    static const char dbc_text[] = "BO_ 1 M: 8 A\n"
                                   " SG_ plain : 0|8@1+ (1,0) [0|0] \"MPa\" B\n"
                                   " SG_ mux m0 : 8|8@1+ (1,0) [0|0] \"rad\" B\n"
                                   " SG_ real : 16|32@1+ (1,0) [0|0] \"rad\" B\n"
                                   "SIG_VALTYPE_ 1 real : 1;\n";
    struct dig_dbc    dbc;
    assert_int_equal(dig_dbc_read(scratch_write("x.dbc", dbc_text), &dbc, NULL), DIG_OK);
    char text[512];
    (void)snprintf(text, sizeof text, "kind: can\nsignals:\n  - {%s, min: 0, max: 1}\n", entry);
    struct dig_signal_map map   = { .groups = 42 };
    struct dig_error      error = { "" };
    assert_int_equal(dig_signal_map_read(scratch_write("bad.yaml", text), &dbc, &map, &error),
                     DIG_EINVAL);
    if (strstr(error.text, expected) == NULL) {
        fail_msg("\"%s\" lacks \"%s\"", error.text, expected);
    }
    assert_int_equal(map.groups, 42);
    dig_dbc_finish(&dbc);
}

static void can_entries_must_fit_the_dbc(void **state)
{
    (void)state;
    check_can("name: boom_rad, signal: plain", "bad.yaml:3: signals[0].message: missing");
    check_can("name: boom_rad, message: N, signal: plain", "\"N\", expected a message of the DBC");
    check_can("name: boom_rad, message: M, signal: none", "\"none\", expected a signal of M");
    check_can("name: boom_rad, message: M, signal: mux", "is multiplexed");
    check_can("name: boom_rad, message: M, signal: real", "is floating-point");
    check_can("name: boom_rad, message: M, signal: plain",
              "plain is in MPa, expected a signal that can be boom_rad");
    check_can("name: boom_head_Pa, message: M, signal: plain, scale: 1",
              "signals[0].scale: 1, expected 1e+06");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(golden_pressure_frame_becomes_pascals),
        cmocka_unit_test(j1939_s_reserved_values_are_not_available),
        cmocka_unit_test(a_frame_with_a_wrong_checksum_is_refused),
        cmocka_unit_test(the_alive_counter_and_the_optional_signals_are_read),
        cmocka_unit_test(ids_are_told_apart_and_short_frames_refused),
        cmocka_unit_test(golden_register_block_becomes_si),
        cmocka_unit_test(wide_registers_signs_and_offsets_are_applied),
        cmocka_unit_test(a_machine_with_the_buckets_pressures_alone_can_be_mapped),
        cmocka_unit_test(a_block_of_force_alone_is_spared),
        cmocka_unit_test(registers_far_apart_come_in_blocks),
        cmocka_unit_test(a_rig_with_a_force_sensor_can_be_mapped),
        cmocka_unit_test(defects_are_refused_with_file_line_and_key),
        cmocka_unit_test(can_entries_must_fit_the_dbc),
    };
    return cmocka_run_group_tests_name("signal_map", tests, scratch_setup, scratch_teardown);
}
