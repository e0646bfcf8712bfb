// A rig that serves Modbus, for the tests of its servers.

#ifndef DIG_TESTS_RIG_MODBUS_RIG_H
#define DIG_TESTS_RIG_MODBUS_RIG_H

#include "tools/rig/bus/serve_modbus.h"

#include "tests/testlib.h"

#include <modbus/modbus.h>

static const uint16_t registers[DIG_RIG_REGISTERS] = { 1,    5123, 0xCF2C, 0xFFFF, 0xFE0C, 12400,
                                                       1000, 0,    34300,  1235,   0,      453 };

struct rig {
    struct dig_rig_faults   faults;
    struct dig_rig_board    board;
    struct dig_rig_modbus  *server;
    struct dig_rig_requests requests;
    int                     port;
};

static inline void stop(struct rig *const rig)
{
    dig_rig_board_stop(&rig->board);
    dig_rig_modbus_join(rig->server, &rig->requests);
    dig_rig_board_finish(&rig->board);
}

static inline void leave(modbus_t *const client)
{
    modbus_close(client);
    modbus_free(client);
}

#endif // DIG_TESTS_RIG_MODBUS_RIG_H
