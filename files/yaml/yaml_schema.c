#include "files/yaml/yaml_schema.h"

#include "core/curve.h"

const cyaml_schema_value_t dig_yaml_number = { CYAML_VALUE_FLOAT(REQUIRED, double) };

const cyaml_schema_value_t dig_yaml_name = { CYAML_VALUE_STRING(REQUIRED, char[DIG_NAME_SIZE], 1,
                                                                DIG_NAME_SIZE - 1) };

const cyaml_schema_value_t dig_yaml_point = { CYAML_VALUE_SEQUENCE_FIXED(REQUIRED, double,
                                                                         &dig_yaml_number, 2) };

#define AXIS(key, axis) CYAML_FIELD_FLOAT(key, REQUIRED, struct dig_gravel, value[axis])

const cyaml_schema_field_t dig_yaml_gravel[] = {
    AXIS("friction", DIG_AXIS_FRICTION),
    AXIS("rolling", DIG_AXIS_ROLLING),
    AXIS("density_kgpm3", DIG_AXIS_DENSITY_kgpm3),
    CYAML_FIELD_END,
};
