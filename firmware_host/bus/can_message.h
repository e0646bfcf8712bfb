// Filters, time stamps and drop counts of a SocketCAN socket.

#ifndef DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H
#define DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H

#include "firmware_host/bus/signal_map.h"

#include <linux/can.h>
#include <stdint.h>
#include <sys/socket.h>
#include <time.h>

/// Filters that pass the map's messages alone: data frames of their identifier and format. One
/// filter a group.
void dig_can_filters(const struct dig_signal_map *map, struct can_filter filter[DIG_GROUPS_MAX]);

/// Arrival of a message that recvmsg() filled, CLOCK_MONOTONIC, ns. The kernel stamps in wall time;
/// wall and now_ns are one instant after it, in both clocks. A wall clock that was just set gives a
/// stamp from the future or more than a second old: then, and without a stamp, now_ns is returned.
int64_t dig_can_stamp_ns(struct msghdr *message, const struct timespec *wall, int64_t now_ns);

/// Frames the socket had no room for since it was opened, by the message; before, where the message
/// does not carry the count. It wraps at 2^32.
uint32_t dig_can_dropped(struct msghdr *message, uint32_t before);

#endif // DIG_FIRMWARE_HOST_BUS_CAN_MESSAGE_H
