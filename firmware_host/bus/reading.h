// A reading: one frame or one poll, decoded, from the input thread to the tick.

#ifndef DIG_FIRMWARE_HOST_BUS_READING_H
#define DIG_FIRMWARE_HOST_BUS_READING_H

#include "core/sample.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_GROUPS_MAX 16 // CAN messages a map may name; a Modbus poll or a replayed line is one

enum dig_reading_state {
    DIG_READING_ABSENT,        // this frame does not carry the signal
    DIG_READING_OK,            //
    DIG_READING_NOT_AVAILABLE, // the sender says it has no value
    DIG_READING_OUT_OF_RANGE,  // outside the map's min … max
    DIG_READING_NAN,
};

struct dig_reading {
    int64_t  time_ns; // CLOCK_MONOTONIC at which it arrived
    unsigned group;   // which message of the map
    bool     has_alive;
    uint64_t alive;   // the sender's counter, raw
    uint64_t counter; // the frame's own counter, raw, where the map names one
    uint8_t  state[DIG_SIGNALS];
    double   value[DIG_SIGNALS]; // SI; meaningful where state is OK
};

#endif // DIG_FIRMWARE_HOST_BUS_READING_H
