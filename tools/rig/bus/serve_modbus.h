// Modbus servers with libmodbus: TCP for several clients, RTU as slave 1 on a serial line. Both
// answer reads of the board's registers and refuse everything else, and count what was asked.

#ifndef DIG_TOOLS_RIG_BUS_SERVE_MODBUS_H
#define DIG_TOOLS_RIG_BUS_SERVE_MODBUS_H

#include "core/error.h"
#include "tools/rig/bus/board.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_RIG_UNIT 1

struct dig_rig_modbus; // a server: a thread, its sockets, its counts

/// Requests by function code: answered with data, and refused with exception 1 (or, for a read
/// outside the map, 2 or 3). Unanswered: asked while the board was silent.
struct dig_rig_requests {
    uint64_t served[256];
    uint64_t refused[256];
    uint64_t unanswered;
    uint64_t excepted, damaged; // answered so because a fault asked for it
    uint64_t clients;           // connections accepted; on RTU times the line was opened
};

/// Opens address (IPV4:PORT, port 0 for any free one; or DEVICE[:BAUD], 8N1, default 115200) and
/// serves it on a thread of its own until the board is stopped. where says what was opened, for
/// people, with the real port. The board must outlive the server. DIG_EINVAL: an address that is
/// none. DIG_EIO: it cannot be opened.
DIG_MUST_CHECK enum dig_status
dig_rig_modbus_start_tcp(const char *address, struct dig_rig_board *board, size_t size,
                         char where[], struct dig_rig_modbus **server, struct dig_error *error);
DIG_MUST_CHECK enum dig_status
dig_rig_modbus_start_rtu(const char *address, struct dig_rig_board *board, size_t size,
                         char where[], struct dig_rig_modbus **server, struct dig_error *error);

/// Waits for the thread of a stopped board, adds its counts to *requests, frees the server. NULL is
/// allowed.
void dig_rig_modbus_join(struct dig_rig_modbus *server, struct dig_rig_requests *requests);

#endif // DIG_TOOLS_RIG_BUS_SERVE_MODBUS_H
