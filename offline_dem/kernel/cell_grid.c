#include "offline_dem/kernel/cell_grid.h"

#include "offline_dem/kernel/crew.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELLS_PER_GRAIN 8

static size_t cell_of(const struct dig_cell_grid *const g, const double x_m[])
{
    const int       a  = g->axis[0];
    const int       b  = g->axis[1];
    const int       c  = g->axis[2];
    const ptrdiff_t ia = dig_cell_grid_along(g, a, x_m[a]);
    const ptrdiff_t ib = dig_cell_grid_along(g, b, x_m[b]);
    const ptrdiff_t ic = dig_cell_grid_along(g, c, x_m[c]);
    return (size_t)(ia + g->count[a] * (ib + g->count[b] * ic));
}

static void size_grid(const struct dig_grains *const grains, struct dig_cell_grid *const g)
{
    double high_m[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int a = 0; a < 3; a++) {
        g->low_m[a] = INFINITY;
    }
    for (size_t i = 0; i < grains->n; i++) {
        for (int a = 0; a < 3; a++) {
            g->low_m[a] = fmin(g->low_m[a], grains->motion[i].x_m[a]);
            high_m[a]   = fmax(high_m[a], grains->motion[i].x_m[a]);
        }
    }
    const double most = (double)(CELLS_PER_GRAIN * grains->n + 64);
    for (;;) {
        double cells = 1.0;
        for (int a = 0; a < 3; a++) {
            const double c = floor((high_m[a] - g->low_m[a]) / g->cell_m) + 1.0;
            g->count[a]    = c < most ? (ptrdiff_t)c : (ptrdiff_t)most;
            cells *= c;
        }
        if (!(cells > most)) {
            break;
        }
        g->cell_m *= 1.5;
    }
    g->cells = (size_t)(g->count[0] * g->count[1] * g->count[2]);
    for (int a = 0; a < 3; a++) {
        int shorter = 0;
        for (int b = 0; b < 3; b++) {
            shorter += g->count[b] < g->count[a] || (g->count[b] == g->count[a] && b < a);
        }
        g->axis[shorter] = a;
    }
}

// The cells of grains, which a crew tells.
struct cells {
    const struct dig_grains    *grains;
    const struct dig_cell_grid *grid;
    uint32_t                   *of; // [n]
};

static void tell_cells(void *const context, const size_t first, const size_t end)
{
    const struct cells *const c = context;
    for (size_t i = first; i < end; i++) {
        c->of[i] = (uint32_t)cell_of(c->grid, c->grains->motion[i].x_m);
    }
}

enum dig_status dig_cell_grid_fill(const struct dig_grains *const grains, const double cell_m,
                                   struct dig_crew *const crew, struct dig_cell_grid *const g)
{
    const size_t n = grains->n;
    g->cell_m      = cell_m;
    size_grid(grains, g);
    g->start             = calloc(g->cells + 2, sizeof *g->start);
    g->member            = calloc(n + 1, sizeof *g->member);
    uint32_t *const cell = malloc((n + 1) * sizeof *cell);
    if (g->start == NULL || g->member == NULL || cell == NULL) {
        dig_cell_grid_finish(g);
        free(cell);
        return DIG_ENOMEM;
    }
    struct cells cells = { grains, g, cell };
    dig_crew_each(crew, n, tell_cells, &cells);
    for (size_t i = 0; i < n; i++) {
        g->start[cell[i] + 2]++;
    }
    for (size_t c = 2; c < g->cells + 2; c++) {
        g->start[c] += g->start[c - 1];
    }
    // start[c + 1] runs ahead while cell c is filled and ends where cell c + 1 begins.
    for (size_t i = 0; i < n; i++) {
        g->member[g->start[cell[i] + 1]++] = (uint32_t)i;
    }
    free(cell);
    return DIG_OK;
}

void dig_cell_grid_finish(struct dig_cell_grid *const g)
{
    free(g->start);
    free(g->member);
}

enum dig_status dig_cell_grid_sort(const struct dig_grains *const grains, const double cell_m,
                                   struct dig_crew *const crew, uint32_t order[])
{
    if (grains->n == 0) {
        return DIG_OK;
    }
    struct dig_cell_grid  g;
    const enum dig_status status = dig_cell_grid_fill(grains, cell_m, crew, &g);
    if (status != DIG_OK) {
        return status;
    }
    memcpy(order, g.member, grains->n * sizeof *order);
    dig_cell_grid_finish(&g);
    return DIG_OK;
}
