// Tests for firmware_host/config/config_map.c and config_map_can.c: maps that are read, and refused

#include "tests/firmware_host/modbus_map.h"

#define BARE                                                                                       \
    "kind: modbus\nsignals:\n"                                                                     \
    "  - {name: boom_rad, register: 1, min: -2, max: 2}\n"                                         \
    "  - {name: arm_rad, register: 2, min: -2, max: 2}\n"                                          \
    "  - {name: bucket_rad, register: 3, min: -2, max: 2}\n"                                       \
    "  - {name: bucket_head_Pa, register: 4, min: 0, max: 4.0e7}\n"

TEST(a_machine_with_the_buckets_pressures_alone_can_be_mapped)
{
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
TEST(a_rig_with_a_force_sensor_can_be_mapped)
{
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

TEST(defects_are_refused_with_file_line_and_key)
{
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
          "bad.yaml:3: signals[0].sign: \"2\", expected one of 1, -1" },
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
          "bad.yaml:2: function: 6, expected 3 … 4" },
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
        assert_contains(error.text, cases[i].expected);
        assert_int_equal(map.groups, 42);
    }
}

// What carries nothing but the force can be done without.
TEST(a_block_of_force_alone_is_spared)
{
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
TEST(registers_far_apart_come_in_blocks)
{
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
    assert_contains(error.text, expected);
    assert_int_equal(map.groups, 42);
    dig_dbc_finish(&dbc);
}

TEST(can_entries_must_fit_the_dbc)
{
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

TESTS_WITH(scratch_setup, scratch_teardown)
