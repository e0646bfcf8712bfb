// A Modbus server of digrig: serve_modbus.c runs it, answer_modbus.c answers for it.

#ifndef DIG_TOOLS_RIG_BUS_MODBUS_SERVER_H
#define DIG_TOOLS_RIG_BUS_MODBUS_SERVER_H

#include "tools/rig/bus/serve_modbus.h"

#include <modbus/modbus.h>
#include <pthread.h>
#include <stdbool.h>

#define DIG_RIG_CLIENTS_MAX 16

struct dig_rig_modbus {
    struct dig_rig_board   *board;
    modbus_t               *context;
    modbus_mapping_t       *map;
    int                     listening; // -1: RTU
    bool                    open;      // RTU: the line is
    int                     clients;
    int                     client[DIG_RIG_CLIENTS_MAX];
    struct dig_rig_requests requests;
    uint64_t                random; // for faults
    pthread_t               thread;
};

/// One request: data for a read, exception 1 for anything else, or what a fault makes of it. False:
/// the connection is to end.
bool dig_rig_modbus_answer(struct dig_rig_modbus *server, const uint8_t request[], int length);

#endif // DIG_TOOLS_RIG_BUS_MODBUS_SERVER_H
