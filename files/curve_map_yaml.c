#include "files/curve_map_yaml.h"

#include "core/name.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define NAME_MAX_LENGTH 39 // of an engine and its version, as a table keeps them

// A factor that is not given is 0.
static const cyaml_schema_field_t column_fields[] = {
    CYAML_FIELD_STRING("column", OPTIONAL, struct dig_map_column, column, 1),
    CYAML_FIELD_STRING("value", OPTIONAL, struct dig_map_column, value, 1),
    CYAML_FIELD_FLOAT("factor", OPTIONAL, struct dig_map_column, factor),
    CYAML_FIELD_END,
};

#define COLUMN(key, flags, field_)                                                                 \
    CYAML_FIELD_MAPPING(key, flags, struct dig_curve_map, field[field_], column_fields)

static const cyaml_schema_field_t columns_fields[] = {
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
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t fields[] = {
    TEXT(dig_curve_map, scene),
    TEXT(dig_curve_map, engine),
    TEXT(dig_curve_map, version),
    ACROSS("columns", REQUIRED, dig_curve_map, columns_fields),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(dig_curve_map, fields);

const char *dig_map_name(const enum dig_map_field field)
{
    assert(field < DIG_MAP_FIELDS);
    return columns_fields[field].key; // in the order of the enum
}

static enum dig_status check_field(const char *const path, const enum dig_map_field field,
                                   const struct dig_map_column *const c,
                                   struct dig_error *const            error)
{
    const bool named = c->column[0] != '\0';
    const bool fixed = c->value[0] != '\0';
    if ((named && fixed) || (field < DIG_MAP_NEEDED && !named && !fixed)) {
        return dig_yaml_refuse(path, error, "columns.%s: expected either a column or a value",
                               dig_map_name(field));
    }
    if (field == DIG_MAP_T_s && !named) {
        return dig_yaml_refuse(path, error, "columns.t_s: a value, expected a column");
    }
    if (!isfinite(c->factor)) {
        return dig_yaml_refuse(path, error, "columns.%s: factor %g, expected a finite one",
                               dig_map_name(field), c->factor);
    }
    return DIG_OK;
}

static enum dig_status check(const char *const path, const struct dig_curve_map *const map,
                             struct dig_error *const error)
{
    if (strlen(map->engine) > NAME_MAX_LENGTH || strlen(map->version) > NAME_MAX_LENGTH) {
        return dig_yaml_refuse(path, error, "%s: expected at most %d characters",
                               strlen(map->engine) > NAME_MAX_LENGTH ? "engine" : "version",
                               NAME_MAX_LENGTH);
    }
    if (!dig_label_ok(map->engine) || !dig_label_ok(map->version)) {
        const bool engine = !dig_label_ok(map->engine);
        return dig_yaml_refuse(path, error, "%s: \"%s\", expected " DIG_LABEL_RULE,
                               engine ? "engine" : "version", engine ? map->engine : map->version);
    }
    enum dig_status status = DIG_OK;
    for (int f = 0; status == DIG_OK && f < DIG_MAP_FIELDS; f++) {
        status = check_field(path, (enum dig_map_field)f, &map->field[f], error);
    }
    return status;
}

static enum dig_status take(const char *const path, cyaml_data_t *const loaded, void *const into,
                            struct dig_error *const error)
{
    const struct dig_curve_map *const text = loaded;
    struct dig_curve_map              map  = *text;
    for (int f = 0; f < DIG_MAP_FIELDS; f++) {
        map.field[f].factor = fabs(text->field[f].factor) > 0.0 ? text->field[f].factor : 1.0;
    }
    const enum dig_status status =
        dig_path_beside(path, text->scene, sizeof map.scene, map.scene)
            ? check(path, &map, error)
            : dig_yaml_refuse(path, error, "scene: expected a shorter path");
    if (status == DIG_OK) {
        *(struct dig_curve_map *)into = map;
    }
    return status;
}

enum dig_status dig_curve_map_read(const char *const path, struct dig_curve_map *const map,
                                   struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, map, error);
}
