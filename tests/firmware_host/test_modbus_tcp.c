// Tests for firmware_host/bus/modbus_tcp.c, over a pair of sockets whose other end is the server.

#include "firmware_host/bus/modbus_tcp.h"

#include "tests/testlib.h"

#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { REGISTERS = 3, REQUEST = 12, ANSWER = 9 + 2 * REGISTERS, HEADER = 9 };

static const struct dig_modbus_request request = {
    .transaction = 0x1234, .unit = 17, .function = 4, .first = 0x0102, .count = REGISTERS
};
static const uint8_t right[ANSWER] = { 0x12, 0x34, 0,    0,    0, 3 + 2 * REGISTERS, 17, 4, 6, 0,
                                       1,    0xff, 0xfe, 0x80, 7 };

// Asks a server that has answered already; errno is 0 before.
static int ask(const uint8_t answer[], const size_t size, uint16_t registers[REGISTERS])
{
    int       end[2];
    modbus_t *bus = modbus_new_tcp("127.0.0.1", 1502);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, end), 0);
    assert_int_equal(modbus_set_socket(bus, end[0]), 0);
    assert_int_equal(modbus_set_response_timeout(bus, 0, 50000), 0);
    assert_int_equal(modbus_set_byte_timeout(bus, 0, 0), 0);
    assert_int_equal(write(end[1], answer, size), size);
    errno          = 0;
    const int read = dig_modbus_tcp_read(bus, &request, registers);
    const int why  = errno;

    const uint8_t expected[REQUEST] = { 0x12, 0x34, 0, 0, 0, 6, 17, 4, 1, 2, 0, REGISTERS };
    uint8_t       asked[REQUEST + 1];
    assert_int_equal(recv(end[1], asked, sizeof asked, 0), REQUEST);
    assert_memory_equal(asked, expected, REQUEST);
    modbus_close(bus);
    modbus_free(bus);
    (void)close(end[1]);
    errno = why;
    return read;
}

static void refuse(const uint8_t answer[], const size_t size, const int why)
{
    uint16_t registers[REGISTERS] = { 1, 2, 3 };
    assert_int_equal(ask(answer, size, registers), -1);
    assert_int_equal(errno, why);
    assert_true(registers[0] == 1 && registers[1] == 2 && registers[2] == 3);
}

TEST(an_answer_to_the_request_is_taken)
{
    uint16_t registers[REGISTERS] = { 0 };
    assert_int_equal(ask(right, ANSWER, registers), 0);
    assert_true(registers[0] == 1 && registers[1] == 0xfffe && registers[2] == 0x8007);
}

TEST(no_byte_before_the_registers_may_be_another)
{
    for (size_t at = 0; at < HEADER; at++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            uint8_t lie[ANSWER + 256] = { 0 };
            memcpy(lie, right, ANSWER);
            lie[at] ^= (uint8_t)(1U << bit);
            // A larger count is believed by libmodbus: the bytes come.
            const size_t size = at == HEADER - 1 && lie[at] > 6 ? sizeof lie : ANSWER;
            // Bit 7 of the function makes an exception of it, whose length is another.
            refuse(lie, size, EMBBADDATA);
        }
    }
}

TEST(an_exception_is_told)
{
    const uint8_t busy[]    = { 0x12, 0x34, 0, 0, 0, 3, 17, 0x84, 6 };
    const uint8_t no_such[] = { 0x12, 0x34, 0, 0, 0, 3, 17, 0x84, 200 };
    const uint8_t longer[]  = { 0x12, 0x34, 0, 0, 0, 4, 17, 0x84, 6 };
    refuse(busy, sizeof busy, EMBXSBUSY);
    refuse(no_such, sizeof no_such, EMBBADEXC);
    refuse(longer, sizeof longer, EMBBADDATA);
}

TEST(half_an_answer_is_waited_for_no_longer_than_a_whole)
{
    for (size_t size = 0; size < ANSWER; size++) {
        refuse(right, size, ETIMEDOUT);
    }
}

TEST(a_connection_that_is_closed_is_told)
{
    int       end[2];
    uint16_t  registers[REGISTERS];
    modbus_t *bus = modbus_new_tcp("127.0.0.1", 1502);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, end), 0);
    assert_int_equal(modbus_set_socket(bus, end[0]), 0);
    (void)close(end[1]);
    assert_int_equal(dig_modbus_tcp_read(bus, &request, registers), -1);
    assert_int_equal(errno, EPIPE);
    modbus_close(bus);
    modbus_free(bus);
}
