#include "files/curve_map_yaml.h"

#include "core/name.h"
#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAME_MAX_LENGTH 39 // of an engine and its version, as a table keeps them

static const char *const names[DIG_MAP_FIELDS] = {
    [DIG_MAP_FRICTION]      = "friction",
    [DIG_MAP_ROLLING]       = "rolling",
    [DIG_MAP_DENSITY_kgpm3] = "density_kgpm3",
    [DIG_MAP_TRAJECTORY]    = "trajectory",
    [DIG_MAP_T_s]           = "t_s",
    [DIG_MAP_MY_Nm]         = "My_Nm",
    [DIG_MAP_FX_N]          = "Fx_N",
    [DIG_MAP_FZ_N]          = "Fz_N",
    [DIG_MAP_CARRIED_kg]    = "carried_kg",
    [DIG_MAP_PACKING]       = "packing",
    [DIG_MAP_DEPTH]         = "depth",
    [DIG_MAP_ATTACK_deg]    = "attack_deg",
};

const char *dig_map_name(const enum dig_map_field field)
{
    assert(field < DIG_MAP_FIELDS);
    return names[field];
}

struct column_text {
    char   column[DIG_MAP_TEXT_SIZE];
    char   value[DIG_MAP_TEXT_SIZE];
    double factor; // 0: not given
};

struct columns_text {
    struct column_text friction, rolling, density_kgpm3, trajectory, t_s, My_Nm, Fx_N, Fz_N,
        carried_kg, packing, depth, attack_deg;
};

struct map_text {
    char                scene[DIG_MAP_PATH_SIZE];
    char                engine[DIG_MAP_TEXT_SIZE];
    char                version[DIG_MAP_TEXT_SIZE];
    struct columns_text columns;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL

static const cyaml_schema_field_t column_fields[] = {
    CYAML_FIELD_STRING("column", OPTIONAL, struct column_text, column, 1),
    CYAML_FIELD_STRING("value", OPTIONAL, struct column_text, value, 1),
    CYAML_FIELD_FLOAT("factor", OPTIONAL, struct column_text, factor),
    CYAML_FIELD_END,
};

#define COLUMN(key, flags) CYAML_FIELD_MAPPING(#key, flags, struct columns_text, key, column_fields)

static const cyaml_schema_field_t columns_fields[] = {
    COLUMN(friction, REQUIRED),
    COLUMN(rolling, REQUIRED),
    COLUMN(density_kgpm3, REQUIRED),
    COLUMN(trajectory, REQUIRED),
    COLUMN(t_s, REQUIRED),
    COLUMN(My_Nm, REQUIRED),
    COLUMN(Fx_N, REQUIRED),
    COLUMN(Fz_N, REQUIRED),
    COLUMN(carried_kg, OPTIONAL),
    COLUMN(packing, OPTIONAL),
    COLUMN(depth, OPTIONAL),
    COLUMN(attack_deg, OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_STRING("scene", REQUIRED, struct map_text, scene, 1),
    CYAML_FIELD_STRING("engine", REQUIRED, struct map_text, engine, 1),
    CYAML_FIELD_STRING("version", REQUIRED, struct map_text, version, 1),
    CYAML_FIELD_MAPPING("columns", REQUIRED, struct map_text, columns, columns_fields),
    CYAML_FIELD_IGNORE("source", OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct map_text, fields) };

static enum dig_status check_field(const char *const path, const enum dig_map_field field,
                                   const struct dig_map_column *const c,
                                   struct dig_error *const            error)
{
    char       key[64];
    const bool named = c->column[0] != '\0';
    const bool fixed = c->value[0] != '\0';
    (void)snprintf(key, sizeof key, "columns.%s", names[field]);
    if ((named && fixed) || (field < DIG_MAP_NEEDED && !named && !fixed)) {
        return dig_yaml_refuse(path, key, error, "expected either a column or a value");
    }
    if (!isfinite(c->factor)) {
        return dig_yaml_refuse(path, key, error, "factor %g, expected a finite one", c->factor);
    }
    return DIG_OK;
}

static enum dig_status check(const char *const path, const struct dig_curve_map *const map,
                             struct dig_error *const error)
{
    if (strlen(map->engine) > NAME_MAX_LENGTH || strlen(map->version) > NAME_MAX_LENGTH) {
        return dig_yaml_refuse(path, strlen(map->engine) > NAME_MAX_LENGTH ? "engine" : "version",
                               error, "expected at most %d characters", NAME_MAX_LENGTH);
    }
    if (!dig_label_ok(map->engine) || !dig_label_ok(map->version)) {
        const bool engine = !dig_label_ok(map->engine);
        return dig_yaml_refuse(path, engine ? "engine" : "version", error,
                               "\"%s\", expected " DIG_LABEL_RULE,
                               engine ? map->engine : map->version);
    }
    enum dig_status status = DIG_OK;
    for (int f = 0; status == DIG_OK && f < DIG_MAP_FIELDS; f++) {
        status = check_field(path, (enum dig_map_field)f, &map->field[f], error);
    }
    return status;
}

static struct dig_map_column column_of(const struct column_text *const text)
{
    struct dig_map_column c = { .factor = fabs(text->factor) > 0.0 ? text->factor : 1.0 };
    memcpy(c.column, text->column, sizeof c.column);
    memcpy(c.value, text->value, sizeof c.value);
    return c;
}

// The folder of the map goes before a relative scene.
static bool resolve(const char *const path, const char *const scene, char out[DIG_MAP_PATH_SIZE])
{
    const char *const slash  = strrchr(path, '/');
    const int         folder = scene[0] == '/' || slash == NULL ? 0 : (int)(slash - path + 1);
    const int         length = snprintf(out, DIG_MAP_PATH_SIZE, "%.*s%s", folder, path, scene);
    return length > 0 && length < DIG_MAP_PATH_SIZE;
}

enum dig_status dig_curve_map_read(const char *const path, struct dig_curve_map *const map,
                                   struct dig_error *const error)
{
    assert(path != NULL && map != NULL);

    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    const struct map_text *const     text   = data;
    const struct columns_text *const c      = &text->columns;
    struct dig_curve_map             loaded = {
                    .field = { [DIG_MAP_FRICTION]      = column_of(&c->friction),
                               [DIG_MAP_ROLLING]       = column_of(&c->rolling),
                               [DIG_MAP_DENSITY_kgpm3] = column_of(&c->density_kgpm3),
                               [DIG_MAP_TRAJECTORY]    = column_of(&c->trajectory),
                               [DIG_MAP_T_s]           = column_of(&c->t_s),
                               [DIG_MAP_MY_Nm]         = column_of(&c->My_Nm),
                               [DIG_MAP_FX_N]          = column_of(&c->Fx_N),
                               [DIG_MAP_FZ_N]          = column_of(&c->Fz_N),
                               [DIG_MAP_CARRIED_kg]    = column_of(&c->carried_kg),
                               [DIG_MAP_PACKING]       = column_of(&c->packing),
                               [DIG_MAP_DEPTH]         = column_of(&c->depth),
                               [DIG_MAP_ATTACK_deg]    = column_of(&c->attack_deg) },
    };
    memcpy(loaded.engine, text->engine, sizeof loaded.engine);
    memcpy(loaded.version, text->version, sizeof loaded.version);
    const bool fits = resolve(path, text->scene, loaded.scene);
    dig_yaml_free(&schema, data);
    status = fits ? check(path, &loaded, error)
                  : dig_yaml_refuse(path, "scene", error, "expected a shorter path");
    if (status == DIG_OK) {
        *map = loaded;
    }
    return status;
}
