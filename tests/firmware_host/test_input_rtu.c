// Tests for firmware_host/bus/input_modbus.c on a serial line: a pseudo terminal whose other end
// the test holds. No answer says which question it belongs to, so one that comes too late must not
// be taken for the next.

#define _XOPEN_SOURCE 600 // posix_openpt() and its kin

#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"

#include "tests/testlib.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define MS        1000000LL
#define REGISTERS 12
#define REQUEST   8                   // unit, function, first, count, CRC
#define ANSWER    (5 + 2 * REGISTERS) // unit, function, bytes, registers, CRC

struct line {
    int                   master, keep; // keep: the slave's end, or closing it would hang up
    struct dig_signal_map map;
    struct dig_input      input;
    struct dig_ring       readings;
    struct dig_latest     log;
    struct dig_reading    reading_memory[256];
    struct dig_log_line   log_memory[3];
    atomic_bool           stop;
    pthread_t             thread;
};

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

static void line_open(struct line *const l)
{
    *l        = (struct line){ 0 };
    l->master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(l->master >= 0);
    assert_int_equal(grantpt(l->master), 0);
    assert_int_equal(unlockpt(l->master), 0);
    struct dig_modbus_address address = { .baud = 115200, .parity = 'N', .unit = 1 };
    (void)snprintf(address.device, sizeof address.device, "%s", ptsname(l->master));
    address.poll_s = 0.005;
    l->keep        = open(address.device, O_RDWR | O_NOCTTY);
    struct termios raw;
    assert_int_equal(tcgetattr(l->keep, &raw), 0);
    raw.c_iflag = raw.c_oflag = raw.c_lflag = 0;
    assert_int_equal(tcsetattr(l->keep, TCSANOW, &raw), 0);
    assert_int_equal(dig_signal_map_read("config/signals/modbus_default.yaml", NULL, &l->map, NULL),
                     DIG_OK);
    assert_int_equal(dig_input_modbus_create(&l->input, &address, &l->map), DIG_OK);
    dig_ring_init(&l->readings, sizeof l->reading_memory[0], 256, l->reading_memory);
    dig_latest_init(&l->log, sizeof l->log_memory[0], l->log_memory);
    l->input.readings = &l->readings;
    l->input.log      = &l->log;
    l->input.stop     = &l->stop;
}

static void *read_main(void *const context)
{
    dig_input_run(&((struct line *)context)->input);
    return NULL;
}

static void line_start(struct line *const l)
{
    assert_int_equal(pthread_create(&l->thread, NULL, read_main, l), 0);
}

static void line_close(struct line *const l)
{
    atomic_store(&l->stop, true);
    assert_int_equal(pthread_join(l->thread, NULL), 0);
    dig_input_destroy(&l->input);
    (void)close(l->keep);
    (void)close(l->master);
}

// Waits for a whole request; ten seconds without one fail.
static void hear(const struct line *const l)
{
    uint8_t request[REQUEST];
    size_t  got = 0;
    while (got < REQUEST) {
        struct pollfd wait = { .fd = l->master, .events = POLLIN };
        assert_int_equal(poll(&wait, 1, 10000), 1);
        const ssize_t n = read(l->master, request + got, REQUEST - got);
        assert_true(n > 0);
        got += (size_t)n;
    }
    assert_int_equal(request[1], 4);
}

// An answer whose boom pressure is so many units of 1 kPa.
static void say(const struct line *const l, const unsigned boom_kPa)
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
    assert_int_equal(write(l->master, answer, ANSWER), ANSWER);
}

static double next_boom_kPa(struct line *const l)
{
    struct dig_reading reading;
    for (int i = 0; i < 10000; i++) {
        if (dig_ring_pop(&l->readings, &reading)) {
            return reading.value[DIG_SIGNAL_BOOM_HEAD_Pa] * 1e-3;
        }
        const struct timespec pause = { .tv_nsec = MS };
        (void)nanosleep(&pause, NULL);
    }
    fail_msg("no reading came");
    return 0.0;
}

static void an_answer_is_decoded(void **state)
{
    (void)state;
    static struct line l;
    line_open(&l);
    line_start(&l);
    for (unsigned i = 0; i < 5; i++) {
        hear(&l);
        say(&l, 8000 + i);
        assert_close(next_boom_kPa(&l), 8000.0 + i, 1e-6);
    }
    assert_int_equal(atomic_load(&l.input.malformed), 0);
    line_close(&l);
}

static void what_lay_on_the_line_before_it_was_asked_is_no_answer(void **state)
{
    (void)state;
    static struct line l;
    line_open(&l);
    say(&l, 1000);
    say(&l, 1001);
    line_start(&l);
    hear(&l);
    say(&l, 8000);
    assert_close(next_boom_kPa(&l), 8000.0, 1e-6);
    line_close(&l);
}

// A gateway that hangs for a while and then answers all it was asked: each of its answers is older
// than the question it would be taken for.
static void answers_that_come_too_late_are_not_taken_for_later_ones(void **state)
{
    (void)state;
    static struct line l;
    line_open(&l);
    line_start(&l);
    hear(&l); // no answer to these two
    hear(&l);
    hear(&l);
    say(&l, 1000);
    say(&l, 1001);
    say(&l, 1002);
    for (unsigned i = 0; i < 5; i++) {
        hear(&l);
        say(&l, 8000 + i);
        assert_close(next_boom_kPa(&l), 8000.0 + i, 1e-6);
    }
    assert_int_equal(atomic_load(&l.input.timeouts), 2);
    assert_int_equal(atomic_load(&l.input.malformed), 1);
    line_close(&l);
}

static void the_answer_after_a_damaged_one_is_not_believed(void **state)
{
    (void)state;
    static struct line   l;
    static const uint8_t rubbish[] = { 1, 4, 2, 0xAA, 0x55, 0, 0 };
    line_open(&l);
    line_start(&l);
    hear(&l);
    assert_int_equal(write(l.master, rubbish, sizeof rubbish), sizeof rubbish);
    hear(&l);
    say(&l, 1000);
    hear(&l);
    say(&l, 8000);
    assert_close(next_boom_kPa(&l), 8000.0, 1e-6);
    assert_int_equal(atomic_load(&l.input.malformed), 2);
    line_close(&l);
}

static void a_refusal_is_an_answer_and_the_next_one_is_believed(void **state)
{
    (void)state;
    static struct line l;
    uint8_t            busy[5] = { 1, 0x84, 6 };
    const uint16_t     crc     = crc16(busy, 3);
    busy[3]                    = (uint8_t)(crc & 0xFF);
    busy[4]                    = (uint8_t)(crc >> 8);
    line_open(&l);
    line_start(&l);
    hear(&l);
    assert_int_equal(write(l.master, busy, sizeof busy), sizeof busy);
    hear(&l);
    say(&l, 8000);
    assert_close(next_boom_kPa(&l), 8000.0, 1e-6);
    assert_int_equal(atomic_load(&l.input.malformed), 1);
    line_close(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_answer_is_decoded),
        cmocka_unit_test(what_lay_on_the_line_before_it_was_asked_is_no_answer),
        cmocka_unit_test(answers_that_come_too_late_are_not_taken_for_later_ones),
        cmocka_unit_test(the_answer_after_a_damaged_one_is_not_believed),
        cmocka_unit_test(a_refusal_is_an_answer_and_the_next_one_is_believed),
    };
    return cmocka_run_group_tests_name("input_rtu", tests, NULL, NULL);
}
