// The Modbus registers shared by the threads: the motion writes them, the servers read them.

#ifndef DIG_TOOLS_RIG_BUS_BOARD_H
#define DIG_TOOLS_RIG_BUS_BOARD_H

#include "tools/rig/bus/modbus_map.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

/// How the servers treat requests, beyond silence.
struct dig_rig_manner {
    double drop, exception, corrupt; // shares of requests
    double slow_s;                   // real time before each answer
    bool   far;                      // registers from DIG_RIG_FAR on are refused as busy …
    bool   far_silent;               // … or are not answered for
};

struct dig_rig_board {
    pthread_mutex_t       lock;
    pthread_cond_t        begun;
    bool                  written;
    uint16_t              registers[DIG_RIG_REGISTERS];
    bool                  silent; // the servers take requests and answer none
    bool                  stop;   // the servers' threads are to end
    struct dig_rig_manner manner;
};

/// False when mutex or condition cannot be made.
bool dig_rig_board_init(struct dig_rig_board *board);
void dig_rig_board_finish(struct dig_rig_board *board);

void dig_rig_board_write(struct dig_rig_board *board, const uint16_t registers[DIG_RIG_REGISTERS],
                         bool silent);

/// Copies the registers out; returns silent. Before anything was written it waits, until there is
/// something or all is to stop: no machine says zeros while it starts.
bool dig_rig_board_read(struct dig_rig_board *board, uint16_t registers[DIG_RIG_REGISTERS]);

/// From the next request on.
void dig_rig_board_behave(struct dig_rig_board *board, const struct dig_rig_manner *manner);
struct dig_rig_manner dig_rig_board_manner(struct dig_rig_board *board);

void dig_rig_board_stop(struct dig_rig_board *board);
bool dig_rig_board_is_stopped(struct dig_rig_board *board);

#endif // DIG_TOOLS_RIG_BUS_BOARD_H
