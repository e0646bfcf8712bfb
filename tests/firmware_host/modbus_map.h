// Modbus maps for tests.

#ifndef DIG_TESTS_FIRMWARE_HOST_MODBUS_MAP_H
#define DIG_TESTS_FIRMWARE_HOST_MODBUS_MAP_H

#include "firmware_host/bus/signal_map.h"
#include "tests/scratch.h"

#define PRESSURES                                                                                  \
    "  - {name: boom_head_Pa, register: 15, type: uint32, min: 0, max: 4.0e7}\n"                   \
    "  - {name: boom_rod_Pa, register: 17, scale: 1e3, min: 0, max: 4.0e7}\n"                      \
    "  - {name: arm_head_Pa, register: 18, scale: 1e3, min: 0, max: 4.0e7}\n"                      \
    "  - {name: arm_rod_Pa, register: 19, scale: 1e3, min: 0, max: 4.0e7}\n"                       \
    "  - {name: bucket_head_Pa, register: 20, scale: 1e3, offset: -1.0e5, min: -1, max: 4.0e7}\n"  \
    "  - {name: bucket_rod_Pa, register: 21, scale: 1e3, min: 0, max: 4.0e7}\n"

static inline struct dig_signal_map modbus_map(const char *const path)
{
    struct dig_signal_map map;
    struct dig_error      error = { "" };
    if (dig_signal_map_read(path, NULL, &map, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return map;
}

#endif // DIG_TESTS_FIRMWARE_HOST_MODBUS_MAP_H
