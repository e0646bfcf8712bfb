// Tests for firmware_host/bus/input_modbus.c and the input thread, against libmodbus' own server on
// loopback.

#include "tests/firmware_host/modbus_client.h"
#include "tests/firmware_host/modbus_server.h"
#include "tests/scratch.h"

#include <string.h>

static struct modbus_server s;
static struct client        c;

static int open_server(void **state)
{
    (void)state;
    s = (struct modbus_server){ 0 };
    modbus_server_open(&s);
    return 0;
}

static void client_start_with(const char *const map, const double poll_s)
{
    const struct dig_modbus_address address = {
        .host = "127.0.0.1", .port = s.port, .unit = 1, .poll_s = poll_s
    };
    client_make(&c, &address, map);
    client_run(&c);
}

static void client_start(void)
{
    client_start_with("config/signals/modbus_default.yaml", 0.005);
}

static void stop(void)
{
    client_stop(&c);
    modbus_server_stop(&s);
}

// What waits is older.
static bool fresh_reading(struct dig_reading *const reading)
{
    while (dig_ring_pop(&c.readings, reading)) {
    }
    return next_reading(&c, reading);
}

static bool next_note(struct dig_log_line *const note)
{
    for (int i = 0; i < 10000; i++) {
        if (dig_latest_take(&c.log, note)) {
            return true;
        }
        pause_ms();
    }
    return false;
}

TEST_WITH(the_block_is_polled_and_decoded_with_reads_only, open_server, NULL)
{
    client_start();
    struct dig_reading reading;
    for (int i = 0; i < 20; i++) {
        assert_true(next_reading(&c, &reading));
    }
    assert_true(reading.has_alive);
    assert_close(reading.value[DIG_SIGNAL_BOOM_rad], 0.2856, 1e-12);
    assert_close(reading.value[DIG_SIGNAL_ARM_rad], -1.0460, 1e-12);
    assert_close(reading.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8.4e6, 1e-6);
    assert_true(reading.time_ns <= dig_input_now_ns());
    stop();
    assert_true(atomic_load(&s.reads) >= 20);
    assert_int_equal(atomic_load(&s.writes), 0);
    assert_int_equal(atomic_load(&s.connections), 1);
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

TEST(a_server_that_comes_late_is_found_and_said)
{
    s = (struct modbus_server){ 0 };
    modbus_server_bind(&s); // not listening: refused
    client_start();
    struct dig_log_line note;
    assert_true(next_note(&note));
    assert_non_null(strstr(note.text, "Connection refused"));
    assert_false(atomic_load(&c.input.connected));
    modbus_server_start(&s);
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    assert_true(next_note(&note));
    assert_string_equal(note.text, ""); // the trouble is over
    stop();
}

TEST_WITH(a_connection_that_breaks_is_made_anew, open_server, NULL)
{
    client_start();
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    atomic_store(&s.hang_up, true);
    while (atomic_load(&s.connections) < 2) {
        pause_ms();
    }
    atomic_store(&s.hang_up, false);
    assert_true(fresh_reading(&reading));
    stop();
    assert_true(atomic_load(&c.input.reconnects) >= 1);
}

// Each byte comes in time, the last of them when the first registers are long past.
TEST_WITH(an_answer_that_dawdles_is_not_taken_for_the_present, open_server, NULL)
{
    atomic_store(&s.slow_ms, 10); // a third of a second in all
    client_start();
    while (atomic_load(&c.input.timeouts) == 0 && atomic_load(&c.input.frames) == 0) {
        pause_ms();
    }
    client_stop(&c);
    assert_true(atomic_load(&c.input.timeouts) > 0);
    assert_int_equal(atomic_load(&c.input.frames), 0);
    modbus_server_stop(&s);
}

TEST_WITH(a_refusal_is_counted_and_borne, open_server, NULL)
{
    client_start();
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    atomic_store(&s.refuse, 3);
    while (atomic_load(&c.input.malformed) < 3) {
        pause_ms();
    }
    assert_true(fresh_reading(&reading));
    assert_int_equal(atomic_load(&c.input.malformed), 3);
    assert_int_equal(atomic_load(&s.connections), 1);
    stop();
}

// Angles here, pressures far off at a fifth of the rate, the oil's temperature once in a while.
static const char far_map[] =
    "kind: modbus\n"
    "blocks:\n"
    "  - {register: 0, registers: 4}\n"
    "  - {register: 1009, registers: 2, poll_Hz: 10}\n"
    "  - {register: 1011, registers: 1, poll_Hz: 2}\n"
    "alive: {register: 0}\n"
    "signals:\n"
    "  - {name: boom_rad, register: 1, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: arm_rad, register: 2, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: bucket_rad, register: 3, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: bucket_head_Pa, register: 1009, scale: 1e3, min: -1, max: 4.0e7}\n"
    "  - {name: bucket_rod_Pa, register: 1010, scale: 1e3, min: -1, max: 4.0e7}\n"
    "  - {name: temperature_degC, register: 1011, scale: 0.1, min: -60, max: 150}\n";

// Takes readings until so many of a block came; how many of each came meanwhile.
static void count_blocks(const unsigned block, const int until, int came[const 3])
{
    struct dig_reading reading;
    while (came[block] < until) {
        assert_true(next_reading(&c, &reading));
        assert_in_range(reading.group, 0, 2);
        assert_true(came[reading.group]++ < 2000);
        if (reading.group == 1) {
            assert_close(reading.value[DIG_SIGNAL_BUCKET_HEAD_Pa], 1e6, 1e-6);
            assert_int_equal(reading.state[DIG_SIGNAL_BOOM_rad], DIG_READING_ABSENT);
        }
        assert_int_equal(reading.has_alive, reading.group == 0);
    }
}

TEST_WITH(blocks_that_lie_apart_are_asked_for_each_at_its_rate, open_server, NULL)
{
    client_start_with(scratch_write("far.yaml", far_map), 0.02);
    int came[3] = { 0 };
    count_blocks(1, 10, came);
    print_message("blocks at 50, 10, 2 Hz: %d, %d, %d readings\n", came[0], came[1], came[2]);
    assert_true(came[0] > 2 * came[1]); // five times as many, were it not for a busy machine
    assert_in_range(came[2], 1, came[1] / 2);
    stop();
    const int first = atomic_load(&s.first);
    const int last  = atomic_load(&s.registers);
    assert_true((first == 0 && last == 4) || (first == 1009 && last == 2) ||
                (first == 1011 && last == 1));
    assert_int_equal(atomic_load(&s.writes), 0);
    assert_int_equal(atomic_load(&s.connections), 1);
}

TEST_WITH(a_block_that_is_refused_is_done_without_or_ends_the_connection, open_server, NULL)
{
    atomic_store(&s.refused, 1011); // the temperature
    client_start_with(scratch_write("far.yaml", far_map), 0.02);
    int came[3] = { 0 };
    while (atomic_load(&c.input.malformed) < 6) {
        count_blocks(1, came[1] + 1, came);
    }
    assert_int_equal(came[2], 0);
    assert_int_equal(atomic_load(&s.connections), 1);

    struct dig_log_line note;
    (void)dig_latest_take(&c.log, &note);
    atomic_store(&s.refused, 1009); // the pressures
    assert_true(next_note(&note));
    assert_non_null(
        strstr(note.text, "registers 1009 … 1010: no good answer: Illegal data address"));
    atomic_store(&s.refused, 0);
    count_blocks(2, 1, came); // all is well again
    stop();
    assert_true(atomic_load(&c.input.reconnects) >= 1);
}

// The boom's pressures tell only the force: while they are refused the rest comes, and they come
// again when they are not.
TEST_WITH(a_block_of_force_alone_is_done_without_until_it_is_back, open_server, NULL)
{
    static const char map[] =
        "kind: modbus\n"
        "blocks:\n"
        "  - {register: 0, registers: 6}\n"
        "  - {register: 1009, registers: 2}\n"
        "signals:\n"
        "  - {name: boom_rad, register: 1, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: arm_rad, register: 2, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: bucket_rad, register: 3, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: bucket_head_Pa, register: 4, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: bucket_rod_Pa, register: 5, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: boom_head_Pa, register: 1009, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: boom_rod_Pa, register: 1010, scale: 1e3, min: -1, max: 4.0e7}\n";
    atomic_store(&s.refused, 1009);
    client_start_with(scratch_write("force.yaml", map), 0.01);
    struct dig_reading reading;
    while (atomic_load(&c.input.malformed) < 7) {
        assert_true(next_reading(&c, &reading));
        assert_int_equal(reading.group, 0);
    }
    assert_int_equal(atomic_load(&s.connections), 1);
    atomic_store(&s.refused, 0);
    do {
        assert_true(next_reading(&c, &reading));
    } while (reading.group != 1);
    assert_close(reading.value[DIG_SIGNAL_BOOM_HEAD_Pa], 1e6, 1e-6);
    stop();
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

static double now_s(void)
{
    return 1e-9 * (double)dig_input_now_ns();
}

// A block without an answer costs the others 200 ms each time: after three times it is asked once
// in five seconds, and said to be silent; the others go on. Then it is back.
TEST_WITH(a_silent_block_is_asked_less_and_less_while_others_answer, open_server, NULL)
{
    atomic_store(&s.muted, 1011); // the temperature, due twice a second
    client_start_with(scratch_write("far.yaml", far_map), 0.02);
    int                 came[3] = { 0 };
    struct dig_log_line note    = { "" };
    bool                said    = false;
    while (!said) {
        count_blocks(0, came[0] + 1, came);
        said = dig_latest_take(&c.log, &note) && strstr(note.text, "silent") != NULL;
    }
    assert_contains(note.text, "registers 1011 … 1011: silent while others answer");
    assert_true(atomic_load(&c.input.timeouts) >= 3);

    const double begin_s = now_s();
    const int    before  = atomic_load(&s.unanswered);
    while (now_s() - begin_s < 2.5) {
        count_blocks(0, came[0] + 1, came);
        count_blocks(1, came[1] + 1, came);
    }
    assert_true(atomic_load(&s.unanswered) - before <= (now_s() - begin_s) / 5.0);
    assert_int_equal(came[2], 0);
    atomic_store(&s.muted, 0);
    count_blocks(2, 1, came);
    while (note.text[0] != '\0') {
        assert_true(next_note(&note));
    }
    stop();
    assert_int_equal(atomic_load(&s.connections), 1);
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

TEST(what_cannot_be_polled_is_refused)
{
    struct dig_signal_map           can     = { .kind = DIG_MAP_CAN };
    const struct dig_modbus_address address = { .host = "127.0.0.1", .port = 1, .poll_s = 0.01 };
    struct dig_input                input   = { 0 };
    assert_int_equal(dig_input_modbus_create(&input, &address, &can), DIG_EINVAL);
    const struct dig_modbus_address never = { .host = "127.0.0.1", .port = 1 };
    can.kind                              = DIG_MAP_MODBUS;
    assert_int_equal(dig_input_modbus_create(&input, &never, &can), DIG_EINVAL);
    assert_null(input.ops);
}
