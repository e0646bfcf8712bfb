// The signal map as it stands in the file, and its schema. Internal to config_map.c.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H

#include "firmware_host/bus/signal_map.h"

#include <cyaml/cyaml.h>

// Pointers: NULL where a key is absent.
struct dig_alive_text {
    char                  *message, *signal;
    unsigned              *reg;
    enum dig_register_type type;
    double                 frozen_ms;
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

struct dig_block_text {
    unsigned *reg;
    unsigned  registers, function;
    double    poll_Hz, delay_ms;
};

struct dig_signal_text {
    char                  *name, *message, *signal;
    unsigned              *reg;
    enum dig_register_type type;
    int                    sign;
    double                 scale, offset, min, max, max_rate;
    uint64_t              *not_available;
    unsigned               not_available_count;
};

struct dig_map_text {
    enum dig_map_kind        kind;
    unsigned                 function;
    bool                     low_word_first, j1939;
    double                   coherent_ms;
    double                  *stuck_ms;
    struct dig_alive_text   *alive;
    struct dig_message_text *messages;
    unsigned                 messages_count;
    struct dig_block_text   *blocks;
    unsigned                 blocks_count;
    struct dig_signal_text  *signals;
    unsigned                 signals_count;
};

/// Of a struct dig_map_text.
extern const cyaml_schema_value_t dig_map_schema;

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_TEXT_H
