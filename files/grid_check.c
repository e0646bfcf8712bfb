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

enum dig_status dig_grid_check_values(const char *const path, const char *const list,
                                      const size_t count, const double value[], const double least,
                                      const double most, struct dig_error *const error)
{
    for (size_t i = 0; i < count; i++) {
        if (!(value[i] >= least && value[i] <= most)) {
            return dig_yaml_refuse(path, error, "%s[%zu]: %g, expected %g to %g", list, i, value[i],
                                   least, most);
        }
        if (i > 0 && !(value[i] > value[i - 1])) {
            return dig_yaml_refuse(path, error, "%s[%zu]: %g after %g, expected ascending values",
                                   list, i, value[i], value[i - 1]);
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
            return dig_yaml_refuse(path, error, "%s: missing, expected a list",
                                   dig_axis_name((enum dig_axis)a));
        }
    }
    if (axes > 0 && grid->packings == 0) {
        return dig_yaml_refuse(path, error, "packings: %s, expected %s",
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
               : dig_yaml_refuse(path, error, "%s: %zu, expected 1 to %d", key, packings,
                                 PACKINGS_MAX);
}

static enum dig_status check_point(const char *const path, const struct dig_grid *const grid,
                                   const size_t i, struct dig_error *const error)
{
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = grid->point[i].gravel.value[a];
        if (!(value >= domain[a].least && value <= domain[a].most)) {
            return dig_yaml_refuse(path, error, "points[%zu].%s: %g, expected %g to %g", i,
                                   dig_axis_name((enum dig_axis)a), value, domain[a].least,
                                   domain[a].most);
        }
    }
    for (size_t k = 0; k < i; k++) {
        if (dig_gravel_is_same(&grid->point[i].gravel, &grid->point[k].gravel) &&
            dig_approach_is_same(&grid->point[i].approach, &grid->point[k].approach)) {
            return dig_yaml_refuse(
                path, error, "points[%zu]: the gravel of points[%zu], expected another", i, k);
        }
    }
    if (grid->point[i].states && grid->effects > 0) {
        return dig_yaml_refuse(
            path, error, "points[%zu]: depth or attack_deg, expected neither beside effects", i);
    }
    const double depth = grid->point[i].approach.depth;
    if (!(depth >= DIG_APPROACH_DEPTH_LEAST && depth <= DIG_APPROACH_DEPTH_MOST)) {
        return dig_yaml_refuse(path, error, "points[%zu].depth: %g, expected %g to %g", i, depth,
                               DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST);
    }
    if (!(fabs(grid->point[i].approach.attack_rad) <= ATTACK_MOST_rad)) {
        return dig_yaml_refuse(path, error, "points[%zu].attack_deg: %g, expected -45 to 45", i,
                               grid->point[i].approach.attack_rad / DIG_RAD_PER_DEG);
    }
    char key[64];
    (void)snprintf(key, sizeof key, "points[%zu].packings", i);
    return dig_grid_check_packings(path, key, grid->point[i].packings, error);
}

static enum dig_status check_effect(const char *const path, const struct dig_grid *const grid,
                                    const size_t i, struct dig_error *const error)
{
    const struct dig_grid_effect *const e = &grid->effect[i];
    for (size_t k = 0; k < i; k++) {
        if (grid->effect[k].effect == e->effect) {
            return dig_yaml_refuse(path, error,
                                   "effects[%zu].name: \"%s\" again, expected a new effect", i,
                                   dig_effect_name(e->effect));
        }
    }
    for (size_t m = 0; m < e->magnitudes; m++) {
        for (size_t k = 0; k < m; k++) {
            if (!(e->magnitude[k] < e->magnitude[m]) && !(e->magnitude[k] > e->magnitude[m])) {
                return dig_yaml_refuse(path, error,
                                       "effects[%zu].magnitudes[%zu]: %g again, expected another",
                                       i, m, e->magnitude[m]);
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
                return dig_yaml_refuse(path, error,
                                       "trajectories[%zu]: \"%s\" again, expected a new name", i,
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
        status = dig_grid_check_values(path, dig_axis_name((enum dig_axis)a), grid->count[a],
                                       grid->value[a], domain[a].least, domain[a].most, error);
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
