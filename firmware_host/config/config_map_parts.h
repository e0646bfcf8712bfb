// Reading the signal map: what config_map.c (map, signals, registers) and config_map_can.c (DBC
// signals, messages) share. Internal to both.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H

#include "core/error.h"
#include "firmware_host/config/config_map_text.h"

/// What is being read, and where errors go.
struct dig_config_map_work {
    const char            *path;
    const struct dig_dbc  *dbc;
    struct dig_signal_map *map;
    struct dig_error      *error;
};

#define REFUSE(work, ...) dig_yaml_refuse((work)->path, (work)->error, __VA_ARGS__)

/// Finds message and signal of an entry in the DBC, and adds its group when it is new. at: the
/// entry's key, "signals[3]". DIG_EINVAL: one is missing, or the signal is not a plain integer.
DIG_MUST_CHECK enum dig_status dig_config_map_find_can(const struct dig_config_map_work *work,
                                                       const char *at, const char *message_name,
                                                       const char           *signal_name,
                                                       struct dig_map_entry *entry);

/// Checks the DBC's unit against the signal's quantity and its scale; without a scale takes the
/// unit's.
DIG_MUST_CHECK enum dig_status dig_config_map_check_unit(const struct dig_config_map_work *work,
                                                         const char *at, size_t signal,
                                                         struct dig_map_entry *entry,
                                                         bool                  scale_given);

/// Reads an entry of `messages`: delay, cycle, counter, checksum. The message must carry a mapped
/// signal.
DIG_MUST_CHECK enum dig_status dig_config_map_read_message(const struct dig_config_map_work *work,
                                                           size_t                            index,
                                                           const struct dig_message_text    *text);

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_MAP_PARTS_H
