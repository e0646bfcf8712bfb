#include "files/grid_check.h"

#include "core/units.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define PACKINGS_MAX    1000
#define ATTACK_MOST_rad (DIG_APPROACH_ATTACK_MOST_rad * (1.0 + 1e-12))

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

// Axes may be left out together where points stand in their place.
static enum dig_status check_present(const char *const path, const struct dig_grid *const grid,
                                     struct dig_error *const error)
{
    size_t axes = 0;
    for (int a = 0; a < DIG_AXES; a++) {
        axes += grid->count[a] > 0 ? 1 : 0;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        if (grid->count[a] == 0 && (axes > 0 || grid->points == 0)) {
            return dig_yaml_refuse(path, dig_axis_name((enum dig_axis)a), error,
                                   "missing, expected a list");
        }
    }
    if (axes > 0 && grid->packings == 0) {
        return dig_yaml_refuse(path, "packings", error, "%s, expected %s",
                               dig_yaml_line(path, "packings") > 0 ? "0" : "missing",
                               dig_yaml_line(path, "packings") > 0 ? "1 to 1000"
                                                                   : "a whole number");
    }
    return DIG_OK;
}

enum dig_status dig_grid_check_packings(const char *const path, const char *const key,
                                        const size_t packings, struct dig_error *const error)
{
    return packings >= 1 && packings <= PACKINGS_MAX
               ? DIG_OK
               : dig_yaml_refuse(path, key, error, "%zu, expected 1 to %d", packings, PACKINGS_MAX);
}

static enum dig_status check_point(const char *const path, const struct dig_grid *const grid,
                                   const size_t i, struct dig_error *const error)
{
    char key[64];
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = grid->point[i].gravel.value[a];
        (void)snprintf(key, sizeof key, "points[%zu].%s", i, dig_axis_name((enum dig_axis)a));
        if (!(value >= domain[a].least && value <= domain[a].most)) {
            return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", value,
                                   domain[a].least, domain[a].most);
        }
    }
    for (size_t k = 0; k < i; k++) {
        if (dig_gravel_is_same(&grid->point[i].gravel, &grid->point[k].gravel) &&
            dig_approach_is_same(&grid->point[i].approach, &grid->point[k].approach)) {
            (void)snprintf(key, sizeof key, "points[%zu]", i);
            return dig_yaml_refuse(path, key, error, "the gravel of points[%zu], expected another",
                                   k);
        }
    }
    if (grid->point[i].states && grid->effects > 0) {
        (void)snprintf(key, sizeof key, "points[%zu]", i);
        return dig_yaml_refuse(path, key, error,
                               "depth or attack_deg, expected neither beside effects");
    }
    const double depth = grid->point[i].approach.depth;
    if (!(depth >= DIG_APPROACH_DEPTH_LEAST && depth <= DIG_APPROACH_DEPTH_MOST)) {
        (void)snprintf(key, sizeof key, "points[%zu].depth", i);
        return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", depth,
                               DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST);
    }
    if (!(fabs(grid->point[i].approach.attack_rad) <= ATTACK_MOST_rad)) {
        (void)snprintf(key, sizeof key, "points[%zu].attack_deg", i);
        return dig_yaml_refuse(path, key, error, "%g, expected -45 to 45",
                               grid->point[i].approach.attack_rad / DIG_RAD_PER_DEG);
    }
    (void)snprintf(key, sizeof key, "points[%zu].packings", i);
    return dig_grid_check_packings(path, key, grid->point[i].packings, error);
}

static enum dig_status check_effect(const char *const path, const struct dig_grid *const grid,
                                    const size_t i, struct dig_error *const error)
{
    char                                key[64];
    const struct dig_grid_effect *const e = &grid->effect[i];
    for (size_t k = 0; k < i; k++) {
        if (grid->effect[k].effect == e->effect) {
            (void)snprintf(key, sizeof key, "effects[%zu].name", i);
            return dig_yaml_refuse(path, key, error, "\"%s\" again, expected a new effect",
                                   dig_effect_name(e->effect));
        }
    }
    for (size_t m = 0; m < e->magnitudes; m++) {
        for (size_t k = 0; k < m; k++) {
            if (!(e->magnitude[k] < e->magnitude[m]) && !(e->magnitude[k] > e->magnitude[m])) {
                (void)snprintf(key, sizeof key, "effects[%zu].magnitudes[%zu]", i, m);
                return dig_yaml_refuse(path, key, error, "%g again, expected another",
                                       e->magnitude[m]);
            }
        }
    }
    return DIG_OK;
}

static enum dig_status check_trajectories(const char *const path, const struct dig_grid *const grid,
                                          struct dig_error *const error)
{
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

enum dig_status dig_grid_check(const char *const path, const struct dig_grid *const grid,
                               struct dig_error *const error)
{
    assert(path != NULL && grid != NULL);
    enum dig_status status = check_present(path, grid, error);
    for (int a = 0; status == DIG_OK && a < DIG_AXES; a++) {
        status = check_axis(path, (enum dig_axis)a, grid, error);
    }
    if (status == DIG_OK && grid->count[0] > 0) {
        status = dig_grid_check_packings(path, "packings", grid->packings, error);
    }
    for (size_t i = 0; status == DIG_OK && i < grid->points; i++) {
        status = check_point(path, grid, i, error);
    }
    for (size_t i = 0; status == DIG_OK && i < grid->effects; i++) {
        status = check_effect(path, grid, i, error);
    }
    return status == DIG_OK ? check_trajectories(path, grid, error) : status;
}
