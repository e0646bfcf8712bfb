#include "files/grid_yaml.h"

#include "files/yaml.h"

#include <assert.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define PACKINGS_MAX 1000

struct name_text {
    char text[DIG_NAME_SIZE];
};

struct grid_text {
    double           friction[DIG_AXIS_VALUES_MAX];
    double           rolling[DIG_AXIS_VALUES_MAX];
    double           density_kgpm3[DIG_AXIS_VALUES_MAX];
    uint32_t         friction_count, rolling_count, density_kgpm3_count;
    uint32_t         packings;
    struct name_text trajectories[DIG_TRAJECTORY_MAX];
    uint32_t         trajectories_count;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };
static const cyaml_schema_value_t name   = { CYAML_VALUE_STRING(REQUIRED, struct name_text, 1,
                                                                DIG_NAME_SIZE - 1) };

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_SEQUENCE("friction", REQUIRED, struct grid_text, friction, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_SEQUENCE("rolling", REQUIRED, struct grid_text, rolling, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_SEQUENCE("density_kgpm3", REQUIRED, struct grid_text, density_kgpm3, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_UINT("packings", REQUIRED, struct grid_text, packings),
    CYAML_FIELD_SEQUENCE("trajectories", OPTIONAL, struct grid_text, trajectories, &name, 0,
                         DIG_TRAJECTORY_MAX),
    CYAML_FIELD_IGNORE("source", OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct grid_text, fields) };

// What a grain can be: frictionless up to interlocking, pumice up to ore.
static const struct {
    double least, most;
} domain[DIG_AXES] = {
    [DIG_AXIS_FRICTION]      = { 0.0, 3.0 },
    [DIG_AXIS_ROLLING]       = { 0.0, 3.0 },
    [DIG_AXIS_DENSITY_kgpm3] = { 100.0, 20000.0 },
};

static enum dig_status check_axis(const char *const path, const enum dig_axis axis,
                                  const struct dig_grid *const grid, struct dig_error *const error)
{
    const double *const value = grid->value[axis];
    for (size_t i = 0; i < grid->count[axis]; i++) {
        char key[64];
        (void)snprintf(key, sizeof key, "%s[%zu]", dig_axis_name(axis), i);
        if (!(value[i] >= domain[axis].least && value[i] <= domain[axis].most)) {
            return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", value[i],
                                   domain[axis].least, domain[axis].most);
        }
        if (i > 0 && !(value[i] > value[i - 1])) {
            return dig_yaml_refuse(path, key, error, "%g after %g, expected ascending values",
                                   value[i], value[i - 1]);
        }
    }
    return DIG_OK;
}

static enum dig_status check(const char *const path, const struct dig_grid *const grid,
                             struct dig_error *const error)
{
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_status status = check_axis(path, (enum dig_axis)a, grid, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (grid->packings < 1 || grid->packings > PACKINGS_MAX) {
        return dig_yaml_refuse(path, "packings", error, "%zu, expected 1 to %d", grid->packings,
                               PACKINGS_MAX);
    }
    for (size_t i = 0; i < grid->trajectories; i++) {
        for (size_t j = 0; j < i; j++) {
            if (strcmp(grid->trajectory[i], grid->trajectory[j]) == 0) {
                char key[64];
                (void)snprintf(key, sizeof key, "trajectories[%zu]", i);
                return dig_yaml_refuse(path, key, error, "\"%s\" again, expected a new name",
                                       grid->trajectory[i]);
            }
        }
    }
    return DIG_OK;
}

static struct dig_grid convert(const struct grid_text *const text)
{
    struct dig_grid grid = {
        .count        = { text->friction_count, text->rolling_count, text->density_kgpm3_count },
        .packings     = text->packings,
        .trajectories = text->trajectories_count,
    };
    memcpy(grid.value[DIG_AXIS_FRICTION], text->friction, sizeof text->friction);
    memcpy(grid.value[DIG_AXIS_ROLLING], text->rolling, sizeof text->rolling);
    memcpy(grid.value[DIG_AXIS_DENSITY_kgpm3], text->density_kgpm3, sizeof text->density_kgpm3);
    for (size_t i = 0; i < grid.trajectories; i++) {
        memcpy(grid.trajectory[i], text->trajectories[i].text, DIG_NAME_SIZE);
    }
    return grid;
}

enum dig_status dig_grid_read(const char *const path, struct dig_grid *const grid,
                              struct dig_error *const error)
{
    assert(path != NULL && grid != NULL);

    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    const struct dig_grid loaded = convert(data);
    dig_yaml_free(&schema, data);
    status = check(path, &loaded, error);
    if (status == DIG_OK) {
        *grid = loaded;
    }
    return status;
}

// "simpleA, simpleB, actual"
static const char *names_of(const struct dig_scene *const scene, const size_t size,
                            char text[const])
{
    size_t used = 0;
    for (size_t i = 0; i < scene->trajectories && used < size; i++) {
        const int n = snprintf(text + used, size - used, "%s%s", i == 0 ? "" : ", ",
                               scene->trajectory[i].name);
        used += n > 0 ? (size_t)n : 0;
    }
    return text;
}

enum dig_status dig_grid_trajectories(const char *const path, const struct dig_grid *const grid,
                                      const struct dig_scene *const scene, size_t *const count,
                                      size_t                  trajectory[const DIG_TRAJECTORY_MAX],
                                      struct dig_error *const error)
{
    assert(path != NULL && grid != NULL && scene != NULL && count != NULL);

    size_t found[DIG_TRAJECTORY_MAX] = { 0 };
    size_t n                         = grid->trajectories;
    for (size_t i = 0; i < n; i++) {
        const struct dig_trajectory *const t = dig_scene_find(scene, grid->trajectory[i]);
        if (t == NULL) {
            char key[64];
            char names[DIG_TRAJECTORY_MAX * (DIG_NAME_SIZE + 2)];
            (void)snprintf(key, sizeof key, "trajectories[%zu]", i);
            return dig_yaml_refuse(path, key, error, "\"%s\", expected one of the scene's: %s",
                                   grid->trajectory[i], names_of(scene, sizeof names, names));
        }
        found[i] = (size_t)(t - scene->trajectory);
    }
    for (size_t i = 0; grid->trajectories == 0 && i < scene->trajectories; i++) {
        found[n++] = i;
    }
    memcpy(trajectory, found, sizeof found);
    *count = n;
    return DIG_OK;
}
