// A Modbus TCP server that lies: modbus_liar PORT SECONDS SEED
//
// Some answers are right, and their registers tell the truth: a front that stands. In all others
// every register is POISON, so that a sample with one of these is one that was made of a lie. A
// connection sees one kind of lie:
//   slow bytes, one at a time; another's transaction; two answers; more registers than asked for; a
//   byte count that is too short; half an answer and a reset; an answer of another function;
//   silence; the connection closed at once; noise; a length in the header that is wrong.
// Prints what it did: connections, requests, right answers, lies.

#include "tests/fuzz/random.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum {
    HEADER    = 6,   // transaction, protocol, length
    REGISTERS = 125, // most of one answer
    BYTES     = HEADER + 3 + 2 * REGISTERS,
    POISON    = 0x1234,
};

enum lie {
    LIE_NONE,
    LIE_SLOW,
    LIE_TRANSACTION,
    LIE_TWICE,
    LIE_LONGER,
    LIE_SHORTER,
    LIE_RESET,
    LIE_FUNCTION,
    LIE_SILENT,
    LIE_CLOSED,
    LIE_NOISE,
    LIE_HEADER,
    LIES
};

// The registers of a front that stands, as config/signals/modbus_default.yaml has them: the first
// answer of tests/fuzz/corpus/modbus.txt.
static const uint16_t truth[] = { 0x0000, 0x0b24, 0xd724, 0xdce8, 0x0000, 0x20d0,
                                  0x03e8, 0x03e8, 0x1068, 0x03e8, 0x07d0, 0x01c2 };

static struct {
    long connections, requests, right, lies;
} count;
static uint16_t alive;

static size_t build(const uint8_t request[], const bool poison, uint8_t answer[BYTES])
{
    const unsigned first     = (unsigned)request[8] << 8 | request[9];
    unsigned       registers = (unsigned)request[10] << 8 | request[11];
    registers                = registers > REGISTERS ? REGISTERS : registers;
    memcpy(answer, request, HEADER + 2);
    answer[4]           = (uint8_t)((3 + 2 * registers) >> 8);
    answer[5]           = (uint8_t)(3 + 2 * registers);
    answer[HEADER + 2]  = (uint8_t)(2 * registers);
    const size_t places = sizeof truth / sizeof truth[0];
    for (unsigned i = 0; i < registers; i++) {
        uint16_t value = poison ? POISON : first + i < places ? truth[first + i] : 0;
        if (!poison && first + i == 0) {
            value = alive++; // the counter of a server that lives
        } else if (!poison && first + i > 4) {
            value = (uint16_t)(value + below(3)); // and sensors that do
        }
        answer[HEADER + 3 + 2 * i] = (uint8_t)(value >> 8);
        answer[HEADER + 4 + 2 * i] = (uint8_t)value;
    }
    return HEADER + 3 + 2 * (size_t)registers;
}

static void nap_ms(const long ms)
{
    const struct timespec pause = { .tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000L };
    (void)nanosleep(&pause, NULL);
}

static void send_all(const int client, const uint8_t bytes[], const size_t size)
{
    (void)send(client, bytes, size, MSG_NOSIGNAL);
}

// One answer with the lie in it; false when the connection is to be reset.
static bool lie_once(const int client, const enum lie lie, const uint8_t request[])
{
    uint8_t    answer[BYTES] = { 0 };
    const bool poison        = lie != LIE_NONE && lie != LIE_SLOW;
    size_t     size          = build(request, poison, answer);
    switch (lie) {
    case LIE_NONE: break;
    case LIE_SLOW:
        for (size_t i = 0; i + 1 < size; i++) {
            send_all(client, answer + i, 1);
            nap_ms(2);
        }
        send_all(client, answer + size - 1, 1);
        return true;
    case LIE_TRANSACTION: answer[1] ^= (uint8_t)(1 + below(255)); break;
    case LIE_TWICE: {
        uint8_t right[BYTES];
        size = build(request, false, right);
        send_all(client, right, size);
        break; // and then the lie
    }
    case LIE_LONGER: {
        const size_t more  = 2 * (1 + below(20)); // zeros
        answer[5]          = (uint8_t)(answer[5] + more);
        answer[HEADER + 2] = (uint8_t)(answer[HEADER + 2] + more);
        size += more;
        break;
    }
    case LIE_HEADER: answer[5] = (uint8_t)(answer[5] + 1 + below(40)); break;
    case LIE_SHORTER: answer[HEADER + 2] = (uint8_t)(answer[HEADER + 2] / 2); break;
    case LIE_RESET: send_all(client, answer, 1 + below(size - 1)); return false;
    case LIE_FUNCTION: answer[HEADER + 1] ^= 1; break;
    case LIE_SILENT: return true;
    case LIE_CLOSED: return false;
    case LIE_NOISE:
        for (size_t i = 0; i < size; i++) {
            answer[i] = (uint8_t)next();
        }
        break;
    case LIES: break;
    }
    send_all(client, answer, size);
    return true;
}

static void serve(const int client)
{
    const enum lie lie   = (enum lie)below(LIES);
    long           asked = 2 + (long)below(30);
    bool           open  = lie != LIE_CLOSED;
    for (; open && asked > 0; asked--) {
        uint8_t       request[BYTES] = { 0 };
        struct pollfd ready          = { .fd = client, .events = POLLIN };
        if (poll(&ready, 1, 1000) <= 0 || recv(client, request, sizeof request, 0) < HEADER + 6) {
            break;
        }
        count.requests++;
        const bool right = below(2) == 0;
        count.right += right ? 1 : 0;
        count.lies += right ? 0 : 1;
        open = lie_once(client, right ? LIE_NONE : lie, request);
    }
    const struct linger now = { .l_onoff = 1 };
    if (lie == LIE_RESET) {
        (void)setsockopt(client, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    }
    (void)close(client);
}

int main(const int argc, char *argv[])
{
    if (argc != 4) {
        (void)fprintf(stderr, "usage: modbus_liar PORT SECONDS SEED\n");
        return 2;
    }
    state                            = strtoull(argv[3], NULL, 0);
    const struct sockaddr_in address = { .sin_family = AF_INET,
                                         .sin_port   = htons((uint16_t)atoi(argv[1])),
                                         .sin_addr   = { htonl(INADDR_LOOPBACK) } };
    const int                on      = 1;
    const int                fd      = socket(AF_INET, SOCK_STREAM, 0);
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, (const struct sockaddr *)&address, sizeof address) != 0 || listen(fd, 4) != 0) {
        perror("modbus_liar");
        return 1;
    }
    const time_t end = time(NULL) + atoi(argv[2]);
    while (time(NULL) < end) {
        struct pollfd ready  = { .fd = fd, .events = POLLIN };
        const int     client = poll(&ready, 1, 200) > 0 ? accept(fd, NULL, NULL) : -1;
        if (client >= 0) {
            count.connections++;
            serve(client);
        }
    }
    (void)printf("%ld %ld %ld %ld\n", count.connections, count.requests, count.right, count.lies);
    return 0;
}
