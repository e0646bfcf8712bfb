// All buses of a run as one: opened together, sent one sample at a time, closed together.

#ifndef DIG_TOOLS_RIG_BUSES_H
#define DIG_TOOLS_RIG_BUSES_H

#include "core/error.h"
#include "core/sample.h"
#include "tools/rig/bus/board.h"
#include "tools/rig/bus/serve_modbus.h"
#include "tools/rig/bus/wire.h"
#include "tools/rig/options.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_RIG_TICK_Hz                                                                            \
    200 // of machine time: the Modbus map's rate; CAN frames go every second tick

struct dig_rig_buses {
    int                     can; // -1: none
    uint64_t                frames_sent, frames_lost;
    uint8_t                 can_alive, can_counter;
    bool                    sealed; // frames carry a counter and a checksum
    struct dig_rig_wire     wire;
    uint16_t                modbus_alive;
    struct dig_rig_board    board;
    struct dig_rig_modbus  *tcp, *rtu; // NULL: none
    struct dig_rig_requests requests;  // filled by the close
};

/// Opens what the options ask for and says so on stderr; the options must outlive the buses.
/// Nothing stays open on failure.
DIG_MUST_CHECK enum dig_status dig_rig_buses_open(const struct dig_rig_options *options,
                                                  struct dig_rig_buses         *buses,
                                                  struct dig_error             *error);

/// Tells one sample at tick number `tick`. moving false: the alive counters stand.
void dig_rig_buses_send(struct dig_rig_buses *buses, int64_t tick, const struct dig_sample *sample,
                        bool moving);

/// Ends the servers and closes everything.
void dig_rig_buses_close(struct dig_rig_buses *buses);

#endif // DIG_TOOLS_RIG_BUSES_H
