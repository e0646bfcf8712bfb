// A datagram from an LCM network. Anybody may send there, and liblcm 1.3.1 does not look where a
// datagram ends: of a channel without end it makes a message of 4 GB, and the offset of a fragment
// may lie outside its message. What listens takes datagrams apart here.

#ifndef DIG_FILES_LCM_DATAGRAM_H
#define DIG_FILES_LCM_DATAGRAM_H

#include "files/lcm/lcm_message.h"

#include <stdbool.h>

#define DIG_LCM_DATAGRAM_MOST 65536 // bytes; UDP carries no more

/// Fills *event's channel, size and data, which point into bytes, and leaves the rest. False, and
/// nothing is written: it is no whole message of LCM's. One of a message that needs several
/// datagrams is none, either: no message of ours does.
bool dig_lcm_datagram(const uint8_t bytes[], size_t size, struct dig_lcm_event *event);

#endif // DIG_FILES_LCM_DATAGRAM_H
