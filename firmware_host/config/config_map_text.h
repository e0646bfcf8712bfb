// The signal map as it stands in the file, and its schema. Internal to config_map.c.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H

#include "firmware_host/bus/signal_map.h"

#include <cyaml/cyaml.h>

// What the map keeps as it stands is where the map has it, in the file's units, 0 where absent.
// Pointers: NULL where a key is absent.

/// A signal, or the alive counter, which has no name.
struct dig_signal_text {
    struct dig_map_entry entry;
    char                *name, *message, *signal;
    unsigned            *reg;
    int                  sign;
    double               frozen_ms; // of the alive counter
};

struct dig_checksum_text {
    char             *signal;
    enum dig_checksum kind;
};

struct dig_message_text {
    char                     *message, *counter;
    double                    delay_ms, cycle_ms;
    struct dig_checksum_text *checksum;
};

struct dig_map_text {
    struct dig_signal_map    map; // its groups are the blocks
    unsigned                 function;
    double                  *stuck_ms;
    struct dig_signal_text  *alive;
    struct dig_message_text *messages;
    unsigned                 messages_count;
    struct dig_signal_text  *signals;
    unsigned                 signals_count;
};

/// Of a struct dig_map_text.
extern const cyaml_schema_value_t dig_map_schema;

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H
