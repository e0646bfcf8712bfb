// One request for registers over Modbus TCP and its answer. libmodbus carries both and knows where
// an answer ends; its own call looks at no protocol, length or unit in an answer's header.

#ifndef DIG_FIRMWARE_HOST_BUS_MODBUS_TCP_H
#define DIG_FIRMWARE_HOST_BUS_MODBUS_TCP_H

#include <modbus/modbus.h>
#include <stdint.h>

struct dig_modbus_request {
    uint16_t transaction;    // unlike the one before: a late answer is known by it
    uint8_t  unit, function; // 3 or 4, which read
    uint16_t first, count;   // of the registers
};

/// Asks over a context that is connected. 0 when every byte of the answer but the registers' is
/// what the request lets expect; registers is written then. Else -1 with errno as of
/// modbus_read_registers(): an exception's, EMBBADDATA for an answer that is none to this request,
/// ETIMEDOUT, or the connection's.
int dig_modbus_tcp_read(modbus_t *bus, const struct dig_modbus_request *request,
                        uint16_t registers[]);

#endif // DIG_FIRMWARE_HOST_BUS_MODBUS_TCP_H
