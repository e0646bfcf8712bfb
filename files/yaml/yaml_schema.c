#include "files/yaml/yaml_schema.h"

#include "core/curve.h"

const struct dig_yaml_field dig_yaml_number = { .kind = DIG_YAML_NUMBER, .size = sizeof(double) };

const struct dig_yaml_field dig_yaml_name = { .kind  = DIG_YAML_TEXT,
                                              .size  = DIG_NAME_SIZE,
                                              .least = 1 };

const struct dig_yaml_field dig_yaml_point = { .kind = DIG_YAML_LIST,
                                               .size = sizeof(struct dig_yaml_point),
                                               .of   = &dig_yaml_number };

#define AXIS(key, axis) FIELD(NUMBER, key, dig_gravel, value[axis], REQUIRED)

const struct dig_yaml_field dig_yaml_gravel[] = {
    AXIS("friction", DIG_AXIS_FRICTION),
    AXIS("rolling", DIG_AXIS_ROLLING),
    AXIS("density_kgpm3", DIG_AXIS_DENSITY_kgpm3),
    END,
};
