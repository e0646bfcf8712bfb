#include "firmware_host/config/config_map_text.h"

#include <stddef.h>

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL
#define POINTER  CYAML_FLAG_POINTER

static const cyaml_strval_t kinds[] = { { "can", DIG_MAP_CAN }, { "modbus", DIG_MAP_MODBUS } };
static const cyaml_strval_t types[] = {
    { "uint16", DIG_REGISTER_UINT16 },   { "int16", DIG_REGISTER_INT16 },
    { "uint32", DIG_REGISTER_UINT32 },   { "int32", DIG_REGISTER_INT32 },
    { "float32", DIG_REGISTER_FLOAT32 },
};

static const cyaml_schema_value_t raw_value = { CYAML_VALUE_UINT(REQUIRED, uint64_t) };

static const cyaml_schema_field_t alive_fields[] = {
    CYAML_FIELD_STRING_PTR("message", OPTIONAL | POINTER, struct dig_alive_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("signal", OPTIONAL | POINTER, struct dig_alive_text, signal, 1, 63),
    CYAML_FIELD_UINT_PTR("register", OPTIONAL | POINTER, struct dig_alive_text, reg),
    CYAML_FIELD_ENUM("type", OPTIONAL, struct dig_alive_text, type, types, CYAML_ARRAY_LEN(types)),
    CYAML_FIELD_FLOAT("frozen_ms", OPTIONAL, struct dig_alive_text, frozen_ms),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t signal_fields[] = {
    CYAML_FIELD_STRING_PTR("name", POINTER, struct dig_signal_text, name, 1, 63),
    CYAML_FIELD_STRING_PTR("message", OPTIONAL | POINTER, struct dig_signal_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("signal", OPTIONAL | POINTER, struct dig_signal_text, signal, 1, 63),
    CYAML_FIELD_UINT_PTR("register", OPTIONAL | POINTER, struct dig_signal_text, reg),
    CYAML_FIELD_ENUM("type", OPTIONAL, struct dig_signal_text, type, types, CYAML_ARRAY_LEN(types)),
    CYAML_FIELD_INT("sign", OPTIONAL, struct dig_signal_text, sign),
    CYAML_FIELD_FLOAT("scale", OPTIONAL, struct dig_signal_text, scale),
    CYAML_FIELD_FLOAT("offset", OPTIONAL, struct dig_signal_text, offset),
    CYAML_FIELD_FLOAT("min", REQUIRED, struct dig_signal_text, min),
    CYAML_FIELD_FLOAT("max", REQUIRED, struct dig_signal_text, max),
    CYAML_FIELD_FLOAT("max_rate", OPTIONAL, struct dig_signal_text, max_rate),
    CYAML_FIELD_SEQUENCE("not_available", OPTIONAL | POINTER, struct dig_signal_text, not_available,
                         &raw_value, 0, DIG_NOT_AVAILABLE_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t signal_value = { CYAML_VALUE_MAPPING(
    REQUIRED, struct dig_signal_text, signal_fields) };

static const cyaml_strval_t checksums[] = {
    { "sum8", DIG_CHECKSUM_SUM8 },
    { "xor8", DIG_CHECKSUM_XOR8 },
    { "crc8_sae_j1850", DIG_CHECKSUM_CRC8_SAE_J1850 },
    { "j1939_tsc1", DIG_CHECKSUM_J1939_TSC1 },
};

static const cyaml_schema_field_t checksum_fields[] = {
    CYAML_FIELD_STRING_PTR("signal", POINTER, struct dig_checksum_text, signal, 1, 63),
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_checksum_text, kind, checksums,
                     CYAML_ARRAY_LEN(checksums)),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t message_fields[] = {
    CYAML_FIELD_STRING_PTR("message", POINTER, struct dig_message_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("counter", OPTIONAL | POINTER, struct dig_message_text, counter, 1, 63),
    CYAML_FIELD_FLOAT("delay_ms", OPTIONAL, struct dig_message_text, delay_ms),
    CYAML_FIELD_FLOAT("cycle_ms", OPTIONAL, struct dig_message_text, cycle_ms),
    CYAML_FIELD_MAPPING_PTR("checksum", OPTIONAL | POINTER, struct dig_message_text, checksum,
                            checksum_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t message_value = { CYAML_VALUE_MAPPING(
    REQUIRED, struct dig_message_text, message_fields) };

static const cyaml_schema_field_t block_fields[] = {
    CYAML_FIELD_UINT_PTR("register", POINTER, struct dig_block_text, reg),
    CYAML_FIELD_UINT("registers", REQUIRED, struct dig_block_text, registers),
    CYAML_FIELD_UINT("function", OPTIONAL, struct dig_block_text, function),
    CYAML_FIELD_FLOAT("poll_Hz", OPTIONAL, struct dig_block_text, poll_Hz),
    CYAML_FIELD_FLOAT("delay_ms", OPTIONAL, struct dig_block_text, delay_ms),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t block_value = { CYAML_VALUE_MAPPING(
    REQUIRED, struct dig_block_text, block_fields) };

static const cyaml_schema_field_t map_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_map_text, kind, kinds, CYAML_ARRAY_LEN(kinds)),
    CYAML_FIELD_UINT("function", OPTIONAL, struct dig_map_text, function),
    CYAML_FIELD_BOOL("low_word_first", OPTIONAL, struct dig_map_text, low_word_first),
    CYAML_FIELD_BOOL("j1939", OPTIONAL, struct dig_map_text, j1939),
    CYAML_FIELD_FLOAT("coherent_ms", OPTIONAL, struct dig_map_text, coherent_ms),
    CYAML_FIELD_FLOAT_PTR("stuck_ms", OPTIONAL | POINTER, struct dig_map_text, stuck_ms),
    CYAML_FIELD_SEQUENCE("messages", OPTIONAL | POINTER, struct dig_map_text, messages,
                         &message_value, 0, DIG_GROUPS_MAX),
    CYAML_FIELD_SEQUENCE("blocks", OPTIONAL | POINTER, struct dig_map_text, blocks, &block_value, 0,
                         DIG_GROUPS_MAX),
    CYAML_FIELD_MAPPING_PTR("alive", OPTIONAL | POINTER, struct dig_map_text, alive, alive_fields),
    CYAML_FIELD_SEQUENCE("signals", POINTER, struct dig_map_text, signals, &signal_value, 1,
                         DIG_SIGNALS),
    CYAML_FIELD_END,
};

const cyaml_schema_value_t dig_map_schema = { CYAML_VALUE_MAPPING(POINTER, struct dig_map_text,
                                                                  map_fields) };
