// What a SocketCAN socket is asked for and says beside its frames: filters, time stamps, and how
// many frames it had no room for.

#ifndef DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H
#define DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H

#include "firmware_host/bus/signal_map.h"

#include <linux/can.h>
#include <stdint.h>
#include <sys/socket.h>
#include <time.h>

/// Only the map's messages, exactly: data frames of that identifier and of that format. One filter
/// a group.
void dig_can_filters(const struct dig_signal_map *map, struct can_filter filter[DIG_GROUPS_MAX]);

/// When a message that recvmsg() filled came, CLOCK_MONOTONIC, ns. The kernel stamps in wall time;
/// the daemon lives in monotonic time. wall and now_ns are of one instant after it came. A wall
/// clock that was just set gives a stamp from the future or from more than a second ago; then, and
/// without a stamp, now_ns is better.
int64_t dig_can_stamp_ns(struct msghdr *message, const struct timespec *wall, int64_t now_ns);

/// Frames the socket had no room for since it was opened, as the message says; before, where it
/// does not say. The count wraps at 2^32.
uint32_t dig_can_dropped(struct msghdr *message, uint32_t before);

#endif // DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H
