// The schema of the signal map.

#include "files/yaml/yaml_schema.h"
#include "firmware_host/config/config_map_parts.h"

#define NAME(key, flags, type, member)                                                             \
    CYAML_FIELD_STRING_PTR(key, (flags) | CYAML_FLAG_POINTER, struct type, member, 1, 63)
#define FLOAT(key, flags, type, member) CYAML_FIELD_FLOAT(key, flags, struct type, member)

static const cyaml_strval_t kinds[] = { { "can", DIG_MAP_CAN }, { "modbus", DIG_MAP_MODBUS } };
static const cyaml_strval_t types[] = {
    { "uint16", DIG_REGISTER_UINT16 },   { "int16", DIG_REGISTER_INT16 },
    { "uint32", DIG_REGISTER_UINT32 },   { "int32", DIG_REGISTER_INT32 },
    { "float32", DIG_REGISTER_FLOAT32 },
};

static const cyaml_schema_value_t raw_value = { CYAML_VALUE_UINT(REQUIRED, uint64_t) };

// Where a value lies on the bus.
#define PLACE                                                                                      \
    NAME("message", OPTIONAL, dig_signal_text, message),                                           \
        NAME("signal", OPTIONAL, dig_signal_text, signal),                                         \
        CYAML_FIELD_UINT_PTR("register", OPTIONAL | CYAML_FLAG_POINTER, struct dig_signal_text,    \
                             reg),                                                                 \
        CYAML_FIELD_ENUM("type", OPTIONAL, struct dig_signal_text, entry.type, types,              \
                         CYAML_ARRAY_LEN(types))

static const cyaml_schema_field_t alive_fields[] = {
    PLACE,
    FLOAT("frozen_ms", OPTIONAL, dig_signal_text, frozen_ms),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t signal_fields[] = {
    NAME("name", REQUIRED, dig_signal_text, name),
    PLACE,
    CYAML_FIELD_INT("sign", OPTIONAL, struct dig_signal_text, sign),
    FLOAT("scale", OPTIONAL, dig_signal_text, entry.scale),
    FLOAT("offset", OPTIONAL, dig_signal_text, entry.offset),
    FLOAT("min", REQUIRED, dig_signal_text, entry.min),
    FLOAT("max", REQUIRED, dig_signal_text, entry.max),
    FLOAT("max_rate", OPTIONAL, dig_signal_text, entry.max_rate),
    LIST("not_available", OPTIONAL, dig_signal_text, entry.not_available_raw, entry.not_available,
         &raw_value, 0, DIG_NOT_AVAILABLE_MAX),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t signal_value = ENTRY(dig_signal_text, signal_fields);

static const cyaml_strval_t checksums[] = {
    { "sum8", DIG_CHECKSUM_SUM8 },
    { "xor8", DIG_CHECKSUM_XOR8 },
    { "crc8_sae_j1850", DIG_CHECKSUM_CRC8_SAE_J1850 },
    { "j1939_tsc1", DIG_CHECKSUM_J1939_TSC1 },
};

static const cyaml_schema_field_t checksum_fields[] = {
    NAME("signal", REQUIRED, dig_checksum_text, signal),
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_checksum_text, kind, checksums,
                     CYAML_ARRAY_LEN(checksums)),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t message_fields[] = {
    NAME("message", REQUIRED, dig_message_text, message),
    NAME("counter", OPTIONAL, dig_message_text, counter),
    FLOAT("delay_ms", OPTIONAL, dig_message_text, delay_ms),
    FLOAT("cycle_ms", OPTIONAL, dig_message_text, cycle_ms),
    CYAML_FIELD_MAPPING_PTR("checksum", OPTIONAL | CYAML_FLAG_POINTER, struct dig_message_text,
                            checksum, checksum_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t message_value = ENTRY(dig_message_text, message_fields);

static const cyaml_schema_field_t block_fields[] = {
    CYAML_FIELD_UINT("register", REQUIRED, struct dig_map_group, first_register),
    CYAML_FIELD_UINT("registers", REQUIRED, struct dig_map_group, registers),
    CYAML_FIELD_UINT("function", OPTIONAL, struct dig_map_group, function),
    FLOAT("poll_Hz", OPTIONAL, dig_map_group, poll_s),
    FLOAT("delay_ms", OPTIONAL, dig_map_group, frame.delay_s),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t block_value = ENTRY(dig_map_group, block_fields);

static const cyaml_schema_field_t map_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_map_text, map.kind, kinds,
                     CYAML_ARRAY_LEN(kinds)),
    CYAML_FIELD_UINT("function", OPTIONAL, struct dig_map_text, function),
    CYAML_FIELD_BOOL("low_word_first", OPTIONAL, struct dig_map_text, map.low_word_first),
    CYAML_FIELD_BOOL("j1939", OPTIONAL, struct dig_map_text, map.j1939),
    FLOAT("coherent_ms", OPTIONAL, dig_map_text, map.coherent_s),
    CYAML_FIELD_FLOAT_PTR("stuck_ms", OPTIONAL | CYAML_FLAG_POINTER, struct dig_map_text, stuck_ms),
    CYAML_FIELD_SEQUENCE("messages", OPTIONAL | CYAML_FLAG_POINTER, struct dig_map_text, messages,
                         &message_value, 0, DIG_GROUPS_MAX),
    LIST("blocks", OPTIONAL, dig_map_text, map.group, map.groups, &block_value, 0, DIG_GROUPS_MAX),
    CYAML_FIELD_MAPPING_PTR("alive", OPTIONAL | CYAML_FLAG_POINTER, struct dig_map_text, alive,
                            alive_fields),
    CYAML_FIELD_SEQUENCE("signals", CYAML_FLAG_POINTER, struct dig_map_text, signals, &signal_value,
                         1, DIG_SIGNALS),
    CYAML_FIELD_END,
};

const cyaml_schema_value_t dig_map_schema = FILE_OF(dig_map_text, map_fields);
