#include "core/chance.h"
#include "tools/rig/bus/modbus_server.h"

#include <assert.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

// On a serial line what a disturbed one would bring before the answer; over TCP, whose own checksum
// lets no flipped bit through, an answer that is not one to this request: of another transaction,
// of another function, or of one register where more were asked for. True: it stands for the
// answer.
static bool damage(const struct dig_rig_modbus *const server, const uint8_t request[])
{
    const int line = modbus_get_socket(server->context);
    if (server->listening < 0) {
        static const uint8_t rubbish[] = { 0x01, 0x04, 0x55 };
        const ssize_t        written   = write(line, rubbish, sizeof rubbish);
        (void)written; // lost on the line is lost
        return false;
    }
    uint8_t answer[] = {
        request[0], request[1], 0, 0, 0, 5, request[6], request[7], 2, 0x12, 0x34
    };
    switch (server->requests.damaged % 3) {
    case 0: answer[1] ^= 0x55; break;
    case 1: answer[7] ^= 0x07; break;
    default: break;
    }
    (void)send(line, answer, sizeof answer, MSG_NOSIGNAL);
    return true;
}

// True for the share of requests that the fault of that kind strikes at time_s.
static bool strikes(struct dig_rig_modbus *const server, const enum dig_rig_fault_kind kind,
                    const double time_s)
{
    const double share = dig_rig_fault_amount(server->board->faults, kind, time_s);
    return share > 0.0 && dig_chance_uniform(&server->random) < share;
}

// What a fault makes of a request: true when it is not to be answered as it should.
static bool misbehave(struct dig_rig_modbus *const server, const uint8_t request[], const bool far,
                      const double time_s)
{
    const struct dig_rig_faults *const faults = server->board->faults;
    const double slow_s = dig_rig_fault_amount(faults, DIG_RIG_FAULT_SLOW, time_s);
    if (slow_s > 0.0) {
        (void)poll(NULL, 0, (int)(1e3 * slow_s));
    }
    if ((far && dig_rig_fault_amount(faults, DIG_RIG_FAULT_FAR_SILENT, time_s) > 0.0) ||
        strikes(server, DIG_RIG_FAULT_DROP, time_s)) {
        server->requests.unanswered++;
        return true;
    }
    if ((far && dig_rig_fault_amount(faults, DIG_RIG_FAULT_FAR, time_s) > 0.0) ||
        strikes(server, DIG_RIG_FAULT_EXCEPTION, time_s)) {
        server->requests.excepted++;
        (void)modbus_reply_exception(server->context, request,
                                     MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY);
        return true;
    }
    if (strikes(server, DIG_RIG_FAULT_CORRUPT, time_s)) {
        server->requests.damaged++;
        return damage(server, request);
    }
    return false;
}

// What libmodbus replies when the first register asked for is this one.
static int reply(struct dig_rig_modbus *const server, const uint8_t request[], const int length,
                 const int header, const int first)
{
    uint8_t near[MODBUS_TCP_MAX_ADU_LENGTH];
    assert(length <= (int)sizeof near);
    memcpy(near, request, (size_t)length);
    near[header + 1] = (uint8_t)(first >> 8);
    near[header + 2] = (uint8_t)(first & 0xFF);
    return modbus_reply(server->context, near, length, server->map);
}

bool dig_rig_modbus_answer(struct dig_rig_modbus *const server, const uint8_t request[],
                           const int length)
{
    const int     header   = modbus_get_header_length(server->context);
    const uint8_t function = request[header];
    const bool    rtu      = server->listening < 0;
    const bool    reads =
        function == MODBUS_FC_READ_HOLDING_REGISTERS || function == MODBUS_FC_READ_INPUT_REGISTERS;
    const int asked = reads ? request[header + 1] << 8 | request[header + 2] : 0;

    const double time_s = dig_rig_board_read(server->board, server->map->tab_registers);
    if (dig_rig_fault_amount(server->board->faults, DIG_RIG_FAULT_MISSING, time_s) > 0.0) {
        server->requests.unanswered++;
        return true;
    }
    if (misbehave(server, request, asked >= DIG_RIG_FAR, time_s)) {
        return true;
    }
    if (!reads) {
        server->requests.refused[function]++;
        // What libmodbus does not know, it does not know the length of either. Before the reply:
        // the client's next request may come right behind it.
        (void)modbus_flush(server->context);
        // A broadcast is never answered.
        return (rtu && request[0] == MODBUS_BROADCAST_ADDRESS) ||
               modbus_reply_exception(server->context, request, MODBUS_EXCEPTION_ILLEGAL_FUNCTION) >
                   0;
    }
    memcpy(server->map->tab_input_registers, server->map->tab_registers,
           sizeof server->map->tab_registers[0] * DIG_RIG_REGISTERS);
    const int       first = asked >= DIG_RIG_FAR ? asked - DIG_RIG_FAR : asked;
    const int       count = request[header + 3] << 8 | request[header + 4];
    const bool      fits  = count >= 1 && first + count <= DIG_RIG_REGISTERS;
    uint64_t *const tally = fits ? server->requests.served : server->requests.refused;
    tally[function]++;
    return reply(server, request, length, header, fits ? first : asked) > 0;
}
