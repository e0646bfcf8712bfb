#include "firmware_host/config/config_text.h"

#include "files/yaml/yaml_schema.h"

#define FLOAT(key, member) CYAML_FIELD_FLOAT(key, OPTIONAL, struct dig_config_text, config.member)
#define WHOLE(key, member) CYAML_FIELD_INT(key, OPTIONAL, struct dig_config_text, config.member)
#define WORD(key, member, flags)                                                                   \
    CYAML_FIELD_STRING_PTR(key, flags, struct dig_config_text, member, 1, 1000)
#define GIVEN CYAML_FLAG_POINTER
#define MAYBE (CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL)

const cyaml_strval_t dig_config_kinds[] = {
    [DIG_INPUT_CAN]        = { "can", DIG_INPUT_CAN },
    [DIG_INPUT_MODBUS_TCP] = { "modbus-tcp", DIG_INPUT_MODBUS_TCP },
    [DIG_INPUT_MODBUS_RTU] = { "modbus-rtu", DIG_INPUT_MODBUS_RTU },
    [DIG_INPUT_REPLAY]     = { "replay", DIG_INPUT_REPLAY },
};

static const cyaml_schema_field_t can_fields[] = {
    WORD("interface", interface, GIVEN),
    WORD("dbc", dbc, GIVEN),
    WORD("map", can_map, GIVEN),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t modbus_fields[] = {
    WORD("address", address, MAYBE), WORD("device", device, MAYBE),
    WHOLE("baud", modbus.baud),      WORD("parity", parity, MAYBE),
    WHOLE("unit", modbus.unit),      WORD("map", modbus_map, GIVEN),
    FLOAT("poll_Hz", modbus.poll_s), CYAML_FIELD_END,
};

static const cyaml_schema_field_t replay_fields[] = {
    WORD("file", replay, GIVEN),
    FLOAT("speed", replay_speed),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t input_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct dig_config_text, config.kind, dig_config_kinds,
                     CYAML_ARRAY_LEN(dig_config_kinds)),
    ACROSS("can", OPTIONAL, dig_config_text, can_fields),
    ACROSS("modbus", OPTIONAL, dig_config_text, modbus_fields),
    ACROSS("replay", OPTIONAL, dig_config_text, replay_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t realtime_fields[] = {
    WHOLE("priority", realtime.priority),
    WHOLE("cpu", realtime.cpu),
    CYAML_FIELD_BOOL("lock_memory", OPTIONAL, struct dig_config_text, config.realtime.lock_memory),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t lcm_fields[] = {
    WORD("url", lcm_url, MAYBE),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t estimator_fields[] = {
    FLOAT("sample_s", estimator.tick_s),
    FLOAT("contact_sigmas", estimator.contact_sigmas),
    FLOAT("contact_hold_s", estimator.contact_hold_s),
    FLOAT("exit_hold_s", estimator.exit_hold_s),
    FLOAT("air_bias_s", estimator.air_bias_s),
    FLOAT("path_limit_m", estimator.path_limit_m),
    FLOAT("outside_floors", estimator.outside_floors),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t match_fields[] = {
    WHOLE("max_evaluations", match_evaluations),
    WORD("state", match_state, MAYBE),
    FLOAT("least_path", match_least_path),
    FLOAT("early_path", match_early_path),
    FLOAT("expires_h", match_expires_s),
    FLOAT("drift_floors", drift_floors),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t identify_fields[] = {
    LIST("trajectories", REQUIRED, dig_config_text, config.identify_trajectory,
         config.identify_trajectories, &dig_yaml_name, 1, DIG_TRAJECTORY_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t publish_fields[] = {
    WHOLE("estimate_every", estimate_every),
    FLOAT("prediction_Hz", prediction_s),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t fields[] = {
    WORD("table", table, GIVEN),
    WORD("machine", machine, GIVEN),
    WORD("scene", scene, MAYBE),
    WORD("model", model, MAYBE),
    ACROSS("input", REQUIRED, dig_config_text, input_fields),
    FLOAT("tick_Hz", tick_s),
    FLOAT("stale_ms", stale_s),
    FLOAT("time_scale", time_scale),
    ACROSS("realtime", OPTIONAL, dig_config_text, realtime_fields),
    ACROSS("lcm", OPTIONAL, dig_config_text, lcm_fields),
    ACROSS("estimator", OPTIONAL, dig_config_text, estimator_fields),
    ACROSS("match", OPTIONAL, dig_config_text, match_fields),
    ACROSS("identify", OPTIONAL, dig_config_text, identify_fields),
    ACROSS("publish", OPTIONAL, dig_config_text, publish_fields),
    CYAML_FIELD_END,
};

const cyaml_schema_value_t dig_config_schema = FILE_OF(dig_config_text, fields);
