// Reading the signal map: how it stands in the file (config_map_text.c has the schema), and what
// config_map.c (map, signals, registers) and config_map_can.c (DBC signals, messages) share.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H

#include "core/error.h"
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

/// What is being read, and what was found wrong with it: then the map is of no use.
struct dig_config_map_work {
    const struct dig_dbc  *dbc;
    struct dig_signal_map *map;
    struct dig_conditions *c;
};

/// Finds message and signal of an entry in the DBC, and adds its group when it is new. at: the
/// entry's key, "signals[3]". Refuses what is missing, and a signal that is not a plain integer.
void dig_config_map_find_can(const struct dig_config_map_work *work, const char *at,
                             const char *message_name, const char *signal_name,
                             struct dig_map_entry *entry);

/// Checks the DBC's unit against the signal's quantity and its scale; without a scale takes the
/// unit's.
void dig_config_map_check_unit(const struct dig_config_map_work *work, const char *at,
                               size_t signal, struct dig_map_entry *entry, bool scale_given);

/// Reads an entry of `messages`: delay, cycle, counter, checksum. The message must carry a mapped
/// signal.
void dig_config_map_read_message(const struct dig_config_map_work *work, size_t index,
                                 const struct dig_message_text *text);

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H
