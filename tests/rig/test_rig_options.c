// Tests for tools/rig/options.c

#include "tools/rig/options.h"

#include "tests/testlib.h"

#include <stdio.h>
#include <string.h>

static enum dig_status parse(const char *const line, struct dig_rig_options *const options,
                             struct dig_error *const error)
{
    static char text[500];
    char       *argv[40] = { NULL };
    int         argc     = 0;
    (void)snprintf(text, sizeof text, "%s", line);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
    return dig_rig_options_parse(argc, argv, options, error);
}

static struct dig_rig_options good(const char *const line)
{
    struct dig_rig_options options;
    struct dig_error       error = { "" };
    if (parse(line, &options, &error) != DIG_OK) {
        fail_msg("%s: %s", line, error.text);
    }
    return options;
}

TEST(examples_of_the_contract_are_understood)
{
    const struct dig_rig_options serve =
        good("digrig serve r.csv --machine m.yaml --can vcan0 --modbus-tcp 127.0.0.1:1502 "
             "--modbus-rtu /dev/ttyS0:9600 --speed 2.5 --loop --start-delay 3 --json "
             "--fault frozen@5:2 --fault missing@9");
    assert_int_equal(serve.command, DIG_RIG_COMMAND_SERVE);
    assert_int_equal(serve.inputs, 1);
    assert_string_equal(serve.input[0], "r.csv");
    assert_string_equal(serve.machine, "m.yaml");
    assert_string_equal(serve.can, "vcan0");
    assert_string_equal(serve.tcp, "127.0.0.1:1502");
    assert_string_equal(serve.rtu, "/dev/ttyS0:9600");
    assert_close(serve.speed, 2.5, 0.0);
    assert_close(serve.start_delay_s, 3.0, 0.0);
    assert_true(serve.loop && serve.json && serve.noise);
    assert_int_equal(serve.faults.faults, 2);
    assert_int_equal(serve.faults.fault[1].kind, DIG_RIG_FAULT_MISSING);

    const struct dig_rig_options record =
        good("digrig record a.csv b.csv --machine m.yaml -o out.csv --truth t.csv --exact "
             "--seed 18446744073709551615 --no-air --scene s.yaml");
    assert_int_equal(record.command, DIG_RIG_COMMAND_RECORD);
    assert_int_equal(record.inputs, 2);
    assert_string_equal(record.out, "out.csv");
    assert_string_equal(record.truth, "t.csv");
    assert_string_equal(record.scene, "s.yaml");
    assert_false(record.noise || record.quantise || record.track.air);
    assert_true(record.seed == UINT64_MAX);

    const struct dig_rig_options air = good("digrig air --machine m.yaml -o air.csv --exact");
    assert_int_equal(air.command, DIG_RIG_COMMAND_AIR);
    assert_int_equal(air.inputs, 0);
    assert_string_equal(air.out, "air.csv");
    assert_false(air.noise || air.quantise);
}

TEST(defaults_are_a_noisy_quantised_machine_in_real_time)
{
    const struct dig_rig_options o = good("digrig record a.csv --machine m.yaml -o out.csv");
    assert_true(o.noise && o.quantise && o.track.air && o.track.blend);
    assert_false(o.loop);
    assert_close(o.speed, 1.0, 0.0);
    assert_close(o.track.scene_tooth_m, 0.09, 0.0);
    assert_close(o.track.rate_Hz, 200.0, 0.0);
    assert_false(good("digrig record a.csv --machine m.yaml -o o.csv --no-noise").noise);
}

TEST(bad_lines_are_refused_with_a_word_and_write_nothing)
{
    static const struct {
        const char *line, *word;
    } bad[] = {
        { "digrig", "record, air or serve" },
        { "digrig dance", "dance" },
        { "digrig record --machine m -o o", "no recording" },
        { "digrig record a.csv -o o", "--machine" },
        { "digrig record a.csv --machine m", "-o" },
        { "digrig record a.csv --machine m -o o --can vcan0", "record takes no --can" },
        { "digrig air a.csv --machine m -o o", "a.csv: air takes no recording" },
        { "digrig air --machine m", "-o" },
        { "digrig air -o o", "--machine" },
        { "digrig air --machine m -o o --scene s", "air takes no --scene" },
        { "digrig serve a.csv --machine m", "no bus" },
        { "digrig serve a.csv --machine m --can c --truth t", "serve takes no --truth" },
        { "digrig serve a.csv --machine m --can c --speed 0", "speed" },
        { "digrig serve a.csv --machine m --can c --speed fast", "speed" },
        { "digrig serve a.csv --machine m --can c --speed nan", "speed" },
        { "digrig serve a.csv --machine m --can c --start-delay -1", "start-delay" },
        { "digrig serve a.csv --machine m --can c --fault melted@3", "melted" },
        { "digrig record a.csv --machine m -o o --seed -4", "seed" },
        { "digrig record a.csv --machine m -o o --seed x", "seed" },
        { "digrig record a.csv --machine m -o o --wings 2", "--wings" },
        { "digrig record a.csv --machine m -o", "-o" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_rig_options options = { .inputs = 42 };
        struct dig_error       error   = { "" };
        assert_int_equal(parse(bad[i].line, &options, &error), DIG_EINVAL);
        assert_int_equal(options.inputs, 42);
        if (strstr(error.text, bad[i].word) == NULL) {
            fail_msg("%s: \"%s\" does not say \"%s\"", bad[i].line, error.text, bad[i].word);
        }
    }
}
