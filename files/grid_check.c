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

void dig_grid_check_values(const char *const list, const size_t count, const double value[],
                           const double least, const double most, struct dig_conditions *const c)
{
    for (size_t i = 0; i < count; i++) {
        dig_require(c, value[i] >= least && value[i] <= most, "%s[%zu]: %g, expected %g to %g",
                    list, i, value[i], least, most);
        dig_require(c, i == 0 || value[i] > value[i - 1],
                    "%s[%zu]: %g after %g, expected ascending values", list, i, value[i],
                    i > 0 ? value[i - 1] : 0.0);
    }
}

void dig_grid_check_packings(const char *const key, const size_t packings,
                             struct dig_conditions *const c)
{
    dig_require(c, packings >= 1 && packings <= PACKINGS_MAX, "%s: %zu, expected 1 to %d", key,
                packings, PACKINGS_MAX);
}

// Axes may be left out together where points stand in their place.
static void check_axes(const char *const path, const struct dig_grid *const grid,
                       struct dig_conditions *const c)
{
    bool any = false;
    for (int a = 0; a < DIG_AXES; a++) {
        any = any || grid->count[a] > 0;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        dig_require(c, grid->count[a] > 0 || (!any && grid->points > 0),
                    "%s: missing, expected a list", dig_axis_name((enum dig_axis)a));
    }
    const bool given = dig_yaml_line(path, "packings") > 0;
    dig_require(c, !any || grid->packings > 0, "packings: %s, expected %s", given ? "0" : "missing",
                given ? "1 to 1000" : "a whole number");
    for (int a = 0; a < DIG_AXES; a++) {
        dig_grid_check_values(dig_axis_name((enum dig_axis)a), grid->count[a], grid->value[a],
                              domain[a].least, domain[a].most, c);
    }
    if (any) {
        dig_grid_check_packings("packings", grid->packings, c);
    }
}

static void check_point(const struct dig_grid *const grid, const size_t i,
                        struct dig_conditions *const c)
{
    const struct dig_grid_point *const p = &grid->point[i];
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = p->gravel.value[a];
        dig_require(c, value >= domain[a].least && value <= domain[a].most,
                    "points[%zu].%s: %g, expected %g to %g", i, dig_axis_name((enum dig_axis)a),
                    value, domain[a].least, domain[a].most);
    }
    for (size_t k = 0; k < i; k++) {
        dig_require(c,
                    !dig_gravel_is_same(&p->gravel, &grid->point[k].gravel) ||
                        !dig_approach_is_same(&p->approach, &grid->point[k].approach),
                    "points[%zu]: the gravel of points[%zu], expected another", i, k);
    }
    dig_require(c, !p->states || grid->effects == 0,
                "points[%zu]: depth or attack_deg, expected neither beside effects", i);
    dig_require(c,
                p->approach.depth >= DIG_APPROACH_DEPTH_LEAST &&
                    p->approach.depth <= DIG_APPROACH_DEPTH_MOST,
                "points[%zu].depth: %g, expected %g to %g", i, p->approach.depth,
                DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST);
    dig_require(c, fabs(p->approach.attack_rad) <= ATTACK_MOST_rad,
                "points[%zu].attack_deg: %g, expected -45 to 45", i,
                p->approach.attack_rad / DIG_RAD_PER_DEG);
    char key[64];
    (void)snprintf(key, sizeof key, "points[%zu].packings", i);
    dig_grid_check_packings(key, p->packings, c);
}

static void check_effect(const struct dig_grid *const grid, const size_t i,
                         struct dig_conditions *const c)
{
    const struct dig_grid_effect *const e = &grid->effect[i];
    for (size_t k = 0; k < i; k++) {
        dig_require(c, grid->effect[k].effect != e->effect,
                    "effects[%zu].name: \"%s\" again, expected a new effect", i,
                    dig_effect_name(e->effect));
    }
    for (size_t m = 0; m < e->magnitudes; m++) {
        for (size_t k = 0; k < m; k++) {
            dig_require(c, e->magnitude[k] < e->magnitude[m] || e->magnitude[k] > e->magnitude[m],
                        "effects[%zu].magnitudes[%zu]: %g again, expected another", i, m,
                        e->magnitude[m]);
        }
    }
}

void dig_grid_check(const char *const path, const struct dig_grid *const grid,
                    struct dig_conditions *const c)
{
    assert(path != NULL && grid != NULL);
    check_axes(path, grid, c);
    for (size_t i = 0; i < grid->points; i++) {
        check_point(grid, i, c);
    }
    for (size_t i = 0; i < grid->effects; i++) {
        check_effect(grid, i, c);
    }
    for (size_t i = 0; i < grid->trajectories; i++) {
        for (size_t j = 0; j < i; j++) {
            dig_require(c, strcmp(grid->trajectory[i], grid->trajectory[j]) != 0,
                        "trajectories[%zu]: \"%s\" again, expected a new name", i,
                        grid->trajectory[i]);
        }
    }
}
