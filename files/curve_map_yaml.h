// Reads the map of `digtable import`: which column of a foreign CSV holds what, in which unit.

#ifndef DIG_FILES_CURVE_MAP_YAML_H
#define DIG_FILES_CURVE_MAP_YAML_H

#include "core/error.h"

#include <stdbool.h>

#define DIG_MAP_TEXT_SIZE 64
#define DIG_MAP_PATH_SIZE 512

/// What a dig's samples are made of. From carried mass on, a map may leave them out.
enum dig_map_field {
    DIG_MAP_FRICTION,
    DIG_MAP_ROLLING,
    DIG_MAP_DENSITY_kgpm3,
    DIG_MAP_TRAJECTORY, // a name
    DIG_MAP_T_s,
    DIG_MAP_MY_Nm,
    DIG_MAP_FX_N,
    DIG_MAP_FZ_N,
    DIG_MAP_CARRIED_kg,
    DIG_MAP_PACKING,
    DIG_MAP_DEPTH, // core/approach.h
    DIG_MAP_ATTACK_deg,
    DIG_MAP_FIELDS,
    DIG_MAP_NEEDED = DIG_MAP_CARRIED_kg
};

/// "friction", …, "attack_deg": the key in the YAML.
const char *dig_map_name(enum dig_map_field field);

/// A field is a column times a factor, or one value for all rows, or not there (both empty).
struct dig_map_column {
    char   column[DIG_MAP_TEXT_SIZE];
    char   value[DIG_MAP_TEXT_SIZE];
    double factor;
};

struct dig_curve_map {
    char                  scene[DIG_MAP_PATH_SIZE]; // relative to the map's folder in the file
    char                  engine[DIG_MAP_TEXT_SIZE];
    char                  version[DIG_MAP_TEXT_SIZE];
    struct dig_map_column field[DIG_MAP_FIELDS];
};

/// Writes on success only; *error names file, line and key.
DIG_MUST_CHECK enum dig_status dig_curve_map_read(const char *path, struct dig_curve_map *map,
                                                  struct dig_error *error);

#endif // DIG_FILES_CURVE_MAP_YAML_H
