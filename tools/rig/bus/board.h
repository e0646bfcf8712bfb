// The Modbus registers shared by the threads: the motion writes them, the servers read them.

#ifndef DIG_TOOLS_RIG_BUS_BOARD_H
#define DIG_TOOLS_RIG_BUS_BOARD_H

#include "tools/rig/bus/fault.h"
#include "tools/rig/bus/modbus_map.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

struct dig_rig_board {
    pthread_mutex_t              lock;
    pthread_cond_t               begun;
    bool                         written;
    uint16_t                     registers[DIG_RIG_REGISTERS];
    double                       time_s; // machine time of the registers
    bool                         stop;   // the servers' threads are to end
    const struct dig_rig_faults *faults; // what the servers make of requests at that time
};

/// The faults must outlive the board. False when mutex or condition cannot be made.
bool dig_rig_board_init(struct dig_rig_board *board, const struct dig_rig_faults *faults);
void dig_rig_board_finish(struct dig_rig_board *board);

void dig_rig_board_write(struct dig_rig_board *board, const uint16_t registers[DIG_RIG_REGISTERS],
                         double time_s);

/// Copies the registers out; returns their time. Before anything was written it waits, until there
/// is something or all is to stop: no machine says zeros while it starts.
double dig_rig_board_read(struct dig_rig_board *board, uint16_t registers[DIG_RIG_REGISTERS]);

void dig_rig_board_stop(struct dig_rig_board *board);
bool dig_rig_board_is_stopped(struct dig_rig_board *board);

#endif // DIG_TOOLS_RIG_BUS_BOARD_H
