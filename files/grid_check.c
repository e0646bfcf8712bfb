#include "files/grid_check.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

void dig_grid_check_ascending(const char *const list, const size_t count, const double value[],
                              struct dig_conditions *const c)
{
    for (size_t i = 1; i < count; i++) {
        dig_require(c, value[i] > value[i - 1], "%s[%zu]: %g after %g, expected ascending values",
                    list, i, value[i], value[i - 1]);
    }
}

// Axes may be left out together where points stand in their place.
static void check_axes(const struct dig_grid *const grid, struct dig_conditions *const c)
{
    bool any = false;
    for (int a = 0; a < DIG_AXES; a++) {
        any = any || grid->count[a] > 0;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const char *const name = dig_axis_name((enum dig_axis)a);
        dig_require(c, grid->count[a] > 0 || (!any && grid->points > 0),
                    "%s: missing, expected a list", name);
        dig_grid_check_ascending(name, grid->count[a], grid->value[a], c);
    }
    dig_require(c, !any || grid->packings > 0, "packings: missing, expected a whole number");
}

static void check_point(const struct dig_grid *const grid, const size_t i,
                        struct dig_conditions *const c)
{
    const struct dig_grid_point *const p = &grid->point[i];
    for (size_t k = 0; k < i; k++) {
        dig_require(c,
                    !dig_gravel_is_same(&p->gravel, &grid->point[k].gravel) ||
                        !dig_approach_is_same(&p->approach, &grid->point[k].approach),
                    "points[%zu]: the gravel of points[%zu], expected another", i, k);
    }
    dig_require(c, !p->states || grid->effects == 0,
                "points[%zu]: depth or attack_deg, expected neither beside effects", i);
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

void dig_grid_check(const struct dig_grid *const grid, struct dig_conditions *const c)
{
    assert(grid != NULL);
    check_axes(grid, c);
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
