#include "firmware_host/bus/modbus_tcp.h"

#include <assert.h>
#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/socket.h>

// transaction, protocol (0), length of the rest, unit, function; then a count of bytes or an
// exception's number, and registers
enum { LENGTH = 4, UNIT = 6, FUNCTION = 7, COUNT = 8, REGISTERS = 9, REQUEST_BYTES = 12 };

#define EXCEPTION 0x80

static unsigned number_at(const uint8_t bytes[], const size_t at)
{
    return (unsigned)bytes[at] << 8 | bytes[at + 1];
}

// All but what follows the function.
static bool answers(const uint8_t answer[], const int size, const uint8_t request[REQUEST_BYTES])
{
    return size >= REGISTERS && memcmp(answer, request, LENGTH) == 0 &&
           number_at(answer, LENGTH) == (unsigned)size - UNIT && answer[UNIT] == request[UNIT] &&
           (answer[FUNCTION] & ~EXCEPTION) == request[FUNCTION];
}

int dig_modbus_tcp_read(modbus_t *const bus, const struct dig_modbus_request *const r,
                        uint16_t registers[])
{
    assert(bus != NULL && r != NULL && registers != NULL);
    assert(r->function == 3 || r->function == 4); // the others write
    const uint8_t request[REQUEST_BYTES] = {
        [0]        = (uint8_t)(r->transaction >> 8),
        [1]        = (uint8_t)r->transaction,
        [5]        = REQUEST_BYTES - UNIT,
        [UNIT]     = r->unit,
        [FUNCTION] = r->function,
        [8]        = (uint8_t)(r->first >> 8),
        [9]        = (uint8_t)r->first,
        [10]       = (uint8_t)(r->count >> 8),
        [11]       = (uint8_t)r->count,
    };
    uint8_t answer[MODBUS_TCP_MAX_ADU_LENGTH];
    errno = EIO; // of a request that went out by half
    if (send(modbus_get_socket(bus), request, sizeof request, MSG_NOSIGNAL) != REQUEST_BYTES) {
        return -1;
    }
    const int size = modbus_receive_confirmation(bus, answer);
    if (size < 0) {
        return -1;
    }
    errno = EMBBADDATA;
    if (!answers(answer, size, request)) {
        return -1;
    }
    if ((answer[FUNCTION] & EXCEPTION) != 0) {
        errno = answer[COUNT] > 0 && answer[COUNT] < MODBUS_EXCEPTION_MAX
                    ? MODBUS_ENOBASE + answer[COUNT]
                    : EMBBADEXC;
        return -1;
    }
    if (size != REGISTERS + 2 * r->count) { // by the answer's own count: libmodbus goes by it
        return -1;
    }
    for (size_t i = 0; i < r->count; i++) {
        registers[i] = (uint16_t)number_at(answer, REGISTERS + 2 * i);
    }
    return 0;
}
