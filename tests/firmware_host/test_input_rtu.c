// Tests for firmware_host/bus/input_modbus.c on a serial line: a pseudo terminal whose other end
// the test holds. No answer says which question it belongs to, so one that comes too late must not
// be taken for the next.

#define _XOPEN_SOURCE 600 // posix_openpt() and its kin

#include "tests/firmware_host/modbus_client.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define REGISTERS 12
#define REQUEST   8                   // unit, function, first, count, CRC
#define ANSWER    (5 + 2 * REGISTERS) // unit, function, bytes, registers, CRC

static int           master, keep; // keep: the slave's end, or closing it would hang up
static struct client c;

static uint16_t crc16(const uint8_t bytes[], const size_t count)
{
    uint16_t crc = 0xFFFF;
    for (size_t i = 0; i < count; i++) {
        crc = (uint16_t)(crc ^ bytes[i]);
        for (int bit = 0; bit < 8; bit++) {
            crc = (uint16_t)((crc & 1) != 0 ? (crc >> 1) ^ 0xA001 : crc >> 1);
        }
    }
    return crc;
}

static int open_line(void **state)
{
    (void)state;
    master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(master >= 0);
    assert_int_equal(grantpt(master), 0);
    assert_int_equal(unlockpt(master), 0);
    struct dig_modbus_address address = {
        .baud = 115200, .parity = 'N', .unit = 1, .poll_s = 0.005
    };
    (void)snprintf(address.device, sizeof address.device, "%s", ptsname(master));
    keep = open(address.device, O_RDWR | O_NOCTTY);
    struct termios raw;
    assert_int_equal(tcgetattr(keep, &raw), 0);
    raw.c_iflag = raw.c_oflag = raw.c_lflag = 0;
    assert_int_equal(tcsetattr(keep, TCSANOW, &raw), 0);
    client_make(&c, &address, "config/signals/modbus_default.yaml");
    return 0;
}

static int close_line(void **state)
{
    (void)state;
    client_stop(&c);
    (void)close(keep);
    (void)close(master);
    return 0;
}

// Waits for a whole request; ten seconds without one fail.
static void hear(void)
{
    uint8_t request[REQUEST];
    size_t  got = 0;
    while (got < REQUEST) {
        struct pollfd wait = { .fd = master, .events = POLLIN };
        assert_int_equal(poll(&wait, 1, 10000), 1);
        const ssize_t n = read(master, request + got, REQUEST - got);
        assert_true(n > 0);
        got += (size_t)n;
    }
    assert_int_equal(request[1], 4);
}

// An answer whose boom pressure is so many units of 1 kPa.
static void say(const unsigned boom_kPa)
{
    static const uint16_t block[REGISTERS] = { 0,    2856, 55076, 56552, 0,    0,
                                               1000, 1000, 4200,  1000,  2000, 450 };
    uint8_t               answer[ANSWER]   = { 1, 4, 2 * REGISTERS };
    for (size_t r = 0; r < REGISTERS; r++) {
        const unsigned value = r == 5 ? boom_kPa : block[r];
        answer[3 + 2 * r]    = (uint8_t)(value >> 8);
        answer[4 + 2 * r]    = (uint8_t)(value & 0xFF);
    }
    const uint16_t crc = crc16(answer, ANSWER - 2);
    answer[ANSWER - 2] = (uint8_t)(crc & 0xFF);
    answer[ANSWER - 1] = (uint8_t)(crc >> 8);
    assert_int_equal(write(master, answer, ANSWER), ANSWER);
}

static double next_boom_kPa(void)
{
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    return reading.value[DIG_SIGNAL_BOOM_HEAD_Pa] * 1e-3;
}

TEST_WITH(an_answer_is_decoded, open_line, close_line)
{
    client_run(&c);
    for (unsigned i = 0; i < 5; i++) {
        hear();
        say(8000 + i);
        assert_close(next_boom_kPa(), 8000.0 + i, 1e-6);
    }
    assert_int_equal(atomic_load(&c.input.malformed), 0);
}

TEST_WITH(what_lay_on_the_line_before_it_was_asked_is_no_answer, open_line, close_line)
{
    say(1000);
    say(1001);
    client_run(&c);
    hear();
    say(8000);
    assert_close(next_boom_kPa(), 8000.0, 1e-6);
}

// A gateway that hangs for a while and then answers all it was asked: each of its answers is older
// than the question it would be taken for.
TEST_WITH(answers_that_come_too_late_are_not_taken_for_later_ones, open_line, close_line)
{
    client_run(&c);
    hear(); // no answer to these two
    hear();
    hear();
    say(1000);
    say(1001);
    say(1002);
    for (unsigned i = 0; i < 5; i++) {
        hear();
        say(8000 + i);
        assert_close(next_boom_kPa(), 8000.0 + i, 1e-6);
    }
    assert_int_equal(atomic_load(&c.input.timeouts), 2);
    assert_int_equal(atomic_load(&c.input.malformed), 1);
}

TEST_WITH(the_answer_after_a_damaged_one_is_not_believed, open_line, close_line)
{
    static const uint8_t rubbish[] = { 1, 4, 2, 0xAA, 0x55, 0, 0 };
    client_run(&c);
    hear();
    assert_int_equal(write(master, rubbish, sizeof rubbish), sizeof rubbish);
    hear();
    say(1000);
    hear();
    say(8000);
    assert_close(next_boom_kPa(), 8000.0, 1e-6);
    assert_int_equal(atomic_load(&c.input.malformed), 2);
}

TEST_WITH(a_refusal_is_an_answer_and_the_next_one_is_believed, open_line, close_line)
{
    uint8_t        busy[5] = { 1, 0x84, 6 };
    const uint16_t crc     = crc16(busy, 3);
    busy[3]                = (uint8_t)(crc & 0xFF);
    busy[4]                = (uint8_t)(crc >> 8);
    client_run(&c);
    hear();
    assert_int_equal(write(master, busy, sizeof busy), sizeof busy);
    hear();
    say(8000);
    assert_close(next_boom_kPa(), 8000.0, 1e-6);
    assert_int_equal(atomic_load(&c.input.malformed), 1);
}
