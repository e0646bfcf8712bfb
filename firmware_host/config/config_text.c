#include "firmware_host/config/config_text.h"

#include <stddef.h>

#define REQUIRED CYAML_FLAG_DEFAULT
#define POINTER  CYAML_FLAG_POINTER
#define OPTIONAL (CYAML_FLAG_OPTIONAL | CYAML_FLAG_POINTER)

#define TEXT(type, name, flags)                                                                    \
    CYAML_FIELD_STRING_PTR(#name, flags, struct dig_##type, name, 1, 1000)
#define NUMBER(type, name) CYAML_FIELD_FLOAT_PTR(#name, OPTIONAL, struct dig_##type, name)
#define WHOLE(type, name)  CYAML_FIELD_INT_PTR(#name, OPTIONAL, struct dig_##type, name)
#define KIND(name)                                                                                 \
    CYAML_FIELD_MAPPING_PTR(#name, OPTIONAL, struct dig_input_text, name, name##_fields)
#define PART(name)                                                                                 \
    CYAML_FIELD_MAPPING(#name, CYAML_FLAG_OPTIONAL, struct dig_config_text, name, name##_fields)

static const cyaml_strval_t kinds[] = {
    { "can", DIG_INPUT_CAN },
    { "modbus-tcp", DIG_INPUT_MODBUS_TCP },
    { "modbus-rtu", DIG_INPUT_MODBUS_RTU },
    { "replay", DIG_INPUT_REPLAY },
};

static const cyaml_schema_field_t can_fields[] = {
    TEXT(can_text, interface, POINTER),
    TEXT(can_text, dbc, POINTER),
    TEXT(can_text, map, POINTER),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t modbus_fields[] = {
    TEXT(modbus_text, address, OPTIONAL),
    TEXT(modbus_text, device, OPTIONAL),
    WHOLE(modbus_text, baud),
    TEXT(modbus_text, parity, OPTIONAL),
    WHOLE(modbus_text, unit),
    TEXT(modbus_text, map, POINTER),
    NUMBER(modbus_text, poll_Hz),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t replay_fields[] = {
    TEXT(replay_text, file, POINTER),
    NUMBER(replay_text, speed),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t input_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_input_text, kind, kinds, CYAML_ARRAY_LEN(kinds)),
    KIND(can),
    KIND(modbus),
    KIND(replay),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t realtime_fields[] = {
    WHOLE(realtime_text, priority),
    WHOLE(realtime_text, cpu),
    CYAML_FIELD_BOOL_PTR("lock_memory", OPTIONAL, struct dig_realtime_text, lock_memory),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t lcm_fields[] = {
    TEXT(lcm_text, url, OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t estimator_fields[] = {
    NUMBER(estimator_text, sample_s),       NUMBER(estimator_text, contact_sigmas),
    NUMBER(estimator_text, contact_hold_s), NUMBER(estimator_text, exit_hold_s),
    NUMBER(estimator_text, air_bias_s),     NUMBER(estimator_text, path_limit_m),
    NUMBER(estimator_text, outside_floors), CYAML_FIELD_END,
};

static const cyaml_schema_field_t match_fields[] = {
    WHOLE(match_text, max_evaluations),
    TEXT(match_text, state, OPTIONAL),
    NUMBER(match_text, least_path),
    NUMBER(match_text, early_path),
    NUMBER(match_text, expires_h),
    NUMBER(match_text, drift_floors),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t name_value = { CYAML_VALUE_STRING(POINTER, char *, 1,
                                                                    DIG_NAME_SIZE - 1) };

static const cyaml_schema_field_t identify_fields[] = {
    CYAML_FIELD_SEQUENCE("trajectories", POINTER, struct dig_identify_text, trajectories,
                         &name_value, 1, DIG_TRAJECTORY_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t publish_fields[] = {
    WHOLE(publish_text, estimate_every),
    NUMBER(publish_text, prediction_Hz),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t config_fields[] = {
    TEXT(config_text, table, POINTER),
    TEXT(config_text, machine, POINTER),
    TEXT(config_text, scene, OPTIONAL),
    TEXT(config_text, model, OPTIONAL),
    CYAML_FIELD_MAPPING("input", REQUIRED, struct dig_config_text, input, input_fields),
    NUMBER(config_text, tick_Hz),
    NUMBER(config_text, stale_ms),
    NUMBER(config_text, time_scale),
    PART(realtime),
    PART(lcm),
    PART(estimator),
    PART(match),
    PART(identify),
    PART(publish),
    CYAML_FIELD_END,
};

const cyaml_schema_value_t dig_config_schema = { CYAML_VALUE_MAPPING(
    POINTER, struct dig_config_text, config_fields) };

const char *dig_input_kind_name(const enum dig_input_kind kind)
{
    for (size_t i = 0; i < CYAML_ARRAY_LEN(kinds); i++) {
        if (kinds[i].val == (int64_t)kind) {
            return kinds[i].str;
        }
    }
    return "";
}
