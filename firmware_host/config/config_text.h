// The configuration as it stands in the file, and its schema. Internal to config.c.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H

#include "firmware_host/config/config.h"

#include <cyaml/cyaml.h>

/// Numbers are where the settings have them, in the file's units, 0 where absent. Texts are NULL
/// where absent.
struct dig_config_text {
    struct dig_config config;
    char             *table, *machine, *model, *scene, *lcm_url, *match_state;
    char             *interface, *dbc, *can_map;
    char             *address, *device, *parity, *modbus_map;
    char             *replay;
};

/// Of a struct dig_config_text.
extern const cyaml_schema_value_t dig_config_schema;

/// The words the kinds of input go by, at their numbers.
extern const cyaml_strval_t dig_config_kinds[DIG_INPUT_REPLAY + 1];

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_TEXT_H
