#include "files/curve_map_yaml.h"

#include "core/name.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define NAME_MAX_LENGTH 39 // of an engine and its version, as a table keeps them

// A factor that is not given is 0.
static const struct dig_yaml_field column_fields[] = {
    FIELD(TEXT, "column", dig_map_column, column, OPTIONAL, .least = 1),
    FIELD(TEXT, "value", dig_map_column, value, OPTIONAL, .least = 1),
    FIELD(NUMBER, "factor", dig_map_column, factor, OPTIONAL),
    END,
};

#define COLUMN(key, flag, field_) PART(key, flag, dig_curve_map, field[field_], column_fields)

static const struct dig_yaml_field columns_fields[] = {
    COLUMN("friction", REQUIRED, DIG_MAP_FRICTION),
    COLUMN("rolling", REQUIRED, DIG_MAP_ROLLING),
    COLUMN("density_kgpm3", REQUIRED, DIG_MAP_DENSITY_kgpm3),
    COLUMN("trajectory", REQUIRED, DIG_MAP_TRAJECTORY),
    COLUMN("t_s", REQUIRED, DIG_MAP_T_s),
    COLUMN("My_Nm", REQUIRED, DIG_MAP_MY_Nm),
    COLUMN("Fx_N", REQUIRED, DIG_MAP_FX_N),
    COLUMN("Fz_N", REQUIRED, DIG_MAP_FZ_N),
    COLUMN("carried_kg", OPTIONAL, DIG_MAP_CARRIED_kg),
    COLUMN("packing", OPTIONAL, DIG_MAP_PACKING),
    COLUMN("depth", OPTIONAL, DIG_MAP_DEPTH),
    COLUMN("attack_deg", OPTIONAL, DIG_MAP_ATTACK_deg),
    END,
};

static const struct dig_yaml_field fields[] = {
    TEXT(dig_curve_map, scene),
    TEXT(dig_curve_map, engine),
    TEXT(dig_curve_map, version),
    ACROSS("columns", REQUIRED, columns_fields),
    SOURCE,
    END,
};

static const struct dig_yaml_file schema = { .of = fields, .size = sizeof(struct dig_curve_map) };

const char *dig_map_name(const enum dig_map_field field)
{
    assert(field < DIG_MAP_FIELDS);
    return columns_fields[field].key; // in the order of the enum
}

static void check_field(const enum dig_map_field field, const struct dig_map_column *const column,
                        struct dig_conditions *const c)
{
    const bool named = column->column[0] != '\0';
    const bool fixed = column->value[0] != '\0';
    dig_require(c, !(named && fixed) && (field >= DIG_MAP_NEEDED || named || fixed),
                "columns.%s: expected either a column or a value", dig_map_name(field));
    dig_require(c, field != DIG_MAP_T_s || named, "columns.t_s: a value, expected a column");
    dig_require(c, isfinite(column->factor), "columns.%s: factor %g, expected a finite one",
                dig_map_name(field), column->factor);
}

static void check_label(const char *const key, const char *const label,
                        struct dig_conditions *const c)
{
    dig_require(c, dig_label_ok(label), "%s: \"%s\", expected " DIG_LABEL_RULE, key, label);
}

static void check_length(const char *const key, const char *const label,
                         struct dig_conditions *const c)
{
    dig_require(c, strlen(label) <= NAME_MAX_LENGTH, "%s: expected at most %d characters", key,
                NAME_MAX_LENGTH);
}

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct dig_curve_map *const map   = loaded;
    const struct dig_curve_map  asked = *map;
    dig_require(c, dig_path_beside(path, asked.scene, sizeof map->scene, map->scene),
                "scene: expected a shorter path");
    check_length("engine", map->engine, c);
    check_length("version", map->version, c);
    check_label("engine", map->engine, c);
    check_label("version", map->version, c);
    for (int f = 0; f < DIG_MAP_FIELDS; f++) {
        struct dig_map_column *const column = &map->field[f];
        column->factor                      = fabs(column->factor) > 0.0 ? column->factor : 1.0;
        check_field((enum dig_map_field)f, column, c);
    }
}

enum dig_status dig_curve_map_read(const char *const path, struct dig_curve_map *const map,
                                   struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, map, error);
}
