// Tests for firmware_host/config/config.c

#include "firmware_host/config/config.h"

#include "tests/scratch.h"

#define MINIMAL "table: t.sqlite\nmachine: m.yaml\n"
#define REPLAY  "input: {kind: replay, replay: {file: r.csv}}\n"

static struct dig_config read_good(const char *const path)
{
    struct dig_config config;
    struct dig_error  error = { "" };
    if (dig_config_read(path, &config, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return config;
}

TEST(paths_are_relative_to_the_file)
{
    char              expected[600];
    struct dig_config c = read_good(scratch_write("c.yaml", MINIMAL REPLAY));
    (void)snprintf(expected, sizeof expected, "%s", scratch_path("t.sqlite"));
    assert_string_equal(c.table.text, expected);
    (void)snprintf(expected, sizeof expected, "%s", scratch_path("r.csv"));
    assert_string_equal(c.replay.text, expected);
    c = read_good(scratch_write("c.yaml", "table: /a/t.sqlite\nmachine: ../m.yaml\n" REPLAY));
    assert_string_equal(c.table.text, "/a/t.sqlite");
    (void)snprintf(expected, sizeof expected, "%s", scratch_path("../m.yaml"));
    assert_string_equal(c.machine.text, expected);
}

// The example in docs/formats.md says it shows the defaults: a file without these keys must mean
// the same.
TEST(the_example_of_the_formats_shows_the_defaults)
{
    const struct dig_config example = read_good("tests/data/formats/digsightd.yaml");
    const struct dig_config minimal = read_good(scratch_write(
        "c.yaml", MINIMAL "input: {kind: can, can: {interface: can0, dbc: d, map: m}}\n"));
    assert_string_equal(example.scene, "rig");
    assert_string_equal(example.can_interface, "can0");
    assert_string_equal(example.map.text, "tests/data/formats/signals_can.yaml");
    assert_int_equal(example.identify_trajectories, 2);
    assert_close(example.tick_s, minimal.tick_s, 0.0);
    assert_close(example.stale_s, minimal.stale_s, 0.0);
    assert_close(example.time_scale, minimal.time_scale, 0.0);
    assert_int_equal(example.realtime.priority, minimal.realtime.priority);
    assert_true(example.realtime.lock_memory == minimal.realtime.lock_memory);
    assert_int_equal(example.realtime.cpu, minimal.realtime.cpu);
    assert_string_equal(example.lcm_url, minimal.lcm_url);
    assert_int_equal(example.match_evaluations, minimal.match_evaluations);
    assert_close(example.match_least_path, minimal.match_least_path, 0.0);
    assert_close(example.match_early_path, minimal.match_early_path, 0.0);
    assert_int_equal(example.estimate_every, minimal.estimate_every);
    assert_close(example.prediction_s, minimal.prediction_s, 1e-15);
    assert_close(example.estimator.tick_s, minimal.estimator.tick_s, 0.0);
    assert_close(example.estimator.contact_sigmas, minimal.estimator.contact_sigmas, 0.0);
    assert_close(example.estimator.contact_hold_s, minimal.estimator.contact_hold_s, 0.0);
    assert_close(example.estimator.exit_hold_s, minimal.estimator.exit_hold_s, 0.0);
    assert_close(example.estimator.air_bias_s, minimal.estimator.air_bias_s, 0.0);
    assert_close(example.estimator.path_limit_m, minimal.estimator.path_limit_m, 0.0);
    assert_close(example.match_expires_s, minimal.match_expires_s, 0.0);
    assert_close(example.drift_floors, minimal.drift_floors, 0.0);
    assert_string_equal(minimal.match_state.text, "");
    assert_string_equal(example.match_state.text, "tests/data/formats/match.json");
    assert_close(example.estimator.outside_floors, minimal.estimator.outside_floors, 0.0);
}

TEST(every_input_is_read)
{
    struct dig_config c = read_good(scratch_write(
        "c.yaml", MINIMAL
        "input: {kind: modbus-tcp, modbus: {address: \"[::1]:502\", map: m, poll_Hz: 50}}\n"));
    assert_int_equal(c.kind, DIG_INPUT_MODBUS_TCP);
    assert_string_equal(c.modbus.host, "::1");
    assert_int_equal(c.modbus.port, 502);
    assert_int_equal(c.modbus.unit, 1);
    assert_close(c.modbus.poll_s, 0.02, 1e-15);
    assert_close(c.estimator.tick_s, 0.02, 1e-15);

    c = read_good(scratch_write(
        "c.yaml",
        MINIMAL "input:\n  kind: modbus-rtu\n"
                "  modbus: {device: /dev/ttyS9, baud: 9600, parity: odd, unit: 17, map: m}\n"));
    assert_string_equal(c.modbus.device, "/dev/ttyS9");
    assert_string_equal(c.modbus.host, "");
    assert_int_equal(c.modbus.baud, 9600);
    assert_int_equal(c.modbus.parity, 'O');
    assert_int_equal(c.modbus.unit, 17);
    assert_close(c.modbus.poll_s, 0.005, 1e-15);

    c = read_good(
        scratch_write("c.yaml", MINIMAL
                      "input: {kind: replay, replay: {file: r.csv, speed: 8}}\ntick_Hz: 500\n"));
    assert_close(c.time_scale, 8.0, 0.0);
    assert_close(c.tick_s, 0.002, 1e-15);
}

TEST(shipped_configurations_are_read)
{
    assert_int_equal(read_good("config/digsightd.yaml").kind, DIG_INPUT_MODBUS_TCP);
    assert_int_equal(read_good("config/digsightd_can.yaml").kind, DIG_INPUT_CAN);
    assert_int_equal(read_good("config/digsightd_rtu.yaml").kind, DIG_INPUT_MODBUS_RTU);
}

TEST(simple_digs_identify_unless_others_are_named)
{
    struct dig_config c = read_good(scratch_write("c.yaml", MINIMAL REPLAY));
    assert_true(dig_config_identifies(&c, "simpleA"));
    assert_false(dig_config_identifies(&c, "actual"));
    c = read_good(scratch_write("c.yaml", MINIMAL REPLAY "identify: {trajectories: [actual]}\n"));
    assert_true(dig_config_identifies(&c, "actual"));
    assert_false(dig_config_identifies(&c, "simpleA"));
}

TEST(defects_are_refused_with_file_line_key_and_write_nothing)
{
    static const struct {
        const char *text, *expected;
    } cases[] = {
        { "table: t\n" REPLAY, "bad.yaml:1: machine: missing" },
        { MINIMAL, "input: missing" },
        { MINIMAL "input: {kind: can}\n",
          "bad.yaml:3: input.can: missing, expected the settings of can" },
        { MINIMAL "input: {kind: can, can: {interface: sixteen_letters_, dbc: d, map: m}}\n",
          "bad.yaml:3: input.can.interface: \"sixteen_letters_…\" of 16 characters, expected" },
        { MINIMAL "input: {kind: modbus-tcp, modbus: {map: m}}\n",
          "input.modbus.address: missing" },
        { MINIMAL "input: {kind: modbus-rtu, modbus: {map: m}}\n", "input.modbus.device: missing" },
        { MINIMAL "input: {kind: modbus-tcp, modbus: {address: nowhere, map: m}}\n",
          "input.modbus.address: \"nowhere\", expected HOST:PORT" },
        { MINIMAL "input: {kind: modbus-tcp, modbus: {address: \"a:0\", map: m}}\n",
          "expected HOST:PORT" },
        { MINIMAL "input: {kind: modbus-tcp, modbus: {address: \"a:99999\", map: m}}\n",
          "expected HOST:PORT" },
        { MINIMAL "input: {kind: modbus-rtu, modbus: {device: d, parity: E, map: m}}\n",
          "input.modbus.parity: \"E\", expected one of none, even, odd" },
        { MINIMAL "input: {kind: modbus-rtu, modbus: {device: d, unit: 300, map: m}}\n",
          "input.modbus.unit: 300, expected 0 … 247" },
        { MINIMAL "input: {kind: replay, replay: {file: r, speed: 0}}\n",
          "input.replay.speed: 0, expected" },
        { MINIMAL REPLAY "tick_Hz: 99\n", "bad.yaml:4: tick_Hz: 99, expected 100 … 2000" },
        { MINIMAL REPLAY "tick_Hz: .nan\n", "bad.yaml:4: tick_Hz" },
        { MINIMAL REPLAY "stale_ms: 0\n", "bad.yaml:4: stale_ms" },
        { MINIMAL REPLAY "time_scale: 2\n", "bad.yaml:4: time_scale: given with a replay" },
        { MINIMAL REPLAY "realtime: {priority: 100}\n",
          "bad.yaml:4: realtime.priority: 100, expected 0 … 99" },
        { MINIMAL REPLAY "estimator: {contact_sigmas: 101}\n",
          "bad.yaml:4: estimator.contact_sigmas: 101, expected 1 … 100" },
        { MINIMAL REPLAY "estimator: {outside_floors: 500}\n",
          "bad.yaml:4: estimator.outside_floors: 500, expected 1 … 100" },
        { MINIMAL "input: {kind: modbus-tcp, modbus: {address: \"a:1\", map: m, poll_Hz: 9}}\n",
          "estimator.sample_s: missing, expected with input.modbus.poll_Hz below 10" },
        { MINIMAL REPLAY "estimator:\n  sample_s: 1\n", "bad.yaml:5: estimator.sample_s" },
        { MINIMAL REPLAY "match: {max_evaluations: 0}\n", "match.max_evaluations: 0, expected" },
        { MINIMAL REPLAY "publish: {estimate_every: 0}\n", "publish.estimate_every: 0, expected" },
        { MINIMAL REPLAY "publish: {prediction_Hz: 0}\n", "publish.prediction_Hz: 0, expected" },
        { MINIMAL REPLAY "lcm: {uri: x}\n", "bad.yaml:4: lcm.uri: unknown key" },
        { MINIMAL REPLAY "lcm: {url: \"udp://239.255.76.67:7667\"}\n",
          "bad.yaml:4: lcm.url: \"udp://239.255.76.67:7667\", expected udpm://" },
        { MINIMAL REPLAY "lcm: {url: \"udpm://192.168.0.4:7667\"}\n", "bad.yaml:4: lcm.url: " },
        { MINIMAL REPLAY "lcm: {url: \"udpm://controller:7667\"}\n", "bad.yaml:4: lcm.url: " },
        { MINIMAL REPLAY "lcm: {url: \"udpm://239.255.76.67.239.255.76.67\"}\n", "lcm.url: " },
        { MINIMAL REPLAY "lcm: {url: \"\"}\n", "bad.yaml:4: lcm.url: " },
        { MINIMAL REPLAY "identify: {trajectories: []}\n", "identify.trajectories" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct dig_config config = { .match_evaluations = 42 };
        struct dig_error  error  = { "" };
        assert_int_equal(dig_config_read(scratch_write("bad.yaml", cases[i].text), &config, &error),
                         DIG_EINVAL);
        assert_contains(error.text, cases[i].expected);
        assert_int_equal(config.match_evaluations, 42);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
