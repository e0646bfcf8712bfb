// Frames out on SocketCAN. The only file here that knows it.

#ifndef DIG_TOOLS_RIG_BUS_SERVE_CAN_H
#define DIG_TOOLS_RIG_BUS_SERVE_CAN_H

#include "core/error.h"
#include "tools/rig/bus/can_layout.h"

/// A raw socket on the interface that sends and hears nothing. DIG_EIO: no such interface, it is
/// down, or the kernel has no CAN.
DIG_MUST_CHECK enum dig_status dig_rig_can_open(const char *interface, int *fd,
                                                struct dig_error *error);

/// DIG_ESTALE: the queue is full and the frame is lost, as on a busy bus. DIG_EIO: errno.
DIG_MUST_CHECK enum dig_status dig_rig_can_send(int fd, const struct dig_rig_can_frame *frame);

void dig_rig_can_close(int fd);

#endif // DIG_TOOLS_RIG_BUS_SERVE_CAN_H
