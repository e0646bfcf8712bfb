// Reading the signal map: how signals and messages stand in the file, and what config_map.c
// (schema, signals, registers) and config_map_can.c (DBC signals, messages) share.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H

#include "core/error.h"
#include "firmware_host/bus/signal_map.h"

#define DIG_MAP_NAME_SIZE 64

/// A signal, or the alive counter, which has no name. What is absent is 0.
struct dig_signal_text {
    struct dig_map_entry entry;
    char   name[DIG_MAP_NAME_SIZE], message[DIG_MAP_NAME_SIZE], signal[DIG_MAP_NAME_SIZE];
    bool   has_reg;
    int    sign;
    double frozen_s; // of the alive counter
};

struct dig_message_text {
    char              message[DIG_MAP_NAME_SIZE], counter[DIG_MAP_NAME_SIZE];
    double            delay_s, cycle_s;
    char              checksum_signal[DIG_MAP_NAME_SIZE];
    enum dig_checksum checksum;
};

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
