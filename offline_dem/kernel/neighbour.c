#include "offline_dem/kernel/neighbour.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// A box of cells around all grains. The number of cells is bounded whatever the spread of the
// grains: a grain thrown far away makes cells larger, not memory.
struct grid {
    double    low_m[3];
    double    cell_m;
    ptrdiff_t count[3];
    int axis[3]; // rows of cells run along axis[0]: the shortest, so that what is near in space
                 // is near in memory
    size_t    cells;
    uint32_t *start;  // [cells + 1]
    uint32_t *member; // [n], cell by cell
};

#define CELLS_PER_GRAIN 8

static ptrdiff_t clamp_cell(const struct grid *const g, const int axis, const double x_m)
{
    const double c = (x_m - g->low_m[axis]) / g->cell_m;
    if (!(c >= 1.0)) {
        return 0;
    }
    return c < (double)g->count[axis] ? (ptrdiff_t)c : g->count[axis] - 1;
}

static size_t cell_of(const struct grid *const g, const double x_m[])
{
    const int       a  = g->axis[0];
    const int       b  = g->axis[1];
    const int       c  = g->axis[2];
    const ptrdiff_t ia = clamp_cell(g, a, x_m[a]);
    const ptrdiff_t ib = clamp_cell(g, b, x_m[b]);
    const ptrdiff_t ic = clamp_cell(g, c, x_m[c]);
    return (size_t)(ia + g->count[a] * (ib + g->count[b] * ic));
}

static void size_grid(const struct dig_grains *const grains, struct grid *const g)
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

static enum dig_status fill_grid(const struct dig_grains *const grains, const double cell_m,
                                 struct grid *const g)
{
    const size_t n = grains->n;
    g->cell_m      = cell_m;
    size_grid(grains, g);
    g->start             = calloc(g->cells + 2, sizeof *g->start);
    g->member            = calloc(n + 1, sizeof *g->member);
    uint32_t *const cell = malloc((n + 1) * sizeof *cell);
    if (g->start == NULL || g->member == NULL || cell == NULL) {
        free(g->start);
        free(g->member);
        free(cell);
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        cell[i] = (uint32_t)cell_of(g, grains->motion[i].x_m);
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

enum dig_status dig_neighbours_sort(const struct dig_grains *const grains, const double cell_m,
                                    uint32_t order[])
{
    if (grains->n == 0) {
        return DIG_OK;
    }
    struct grid           g;
    const enum dig_status status = fill_grid(grains, cell_m, &g);
    if (status != DIG_OK) {
        return status;
    }
    memcpy(order, g.member, grains->n * sizeof *order);
    free(g.start);
    free(g.member);
    return DIG_OK;
}

static enum dig_status make_room(struct dig_neighbours *const list, const size_t need)
{
    if (need <= list->room) {
        return DIG_OK;
    }
    const size_t    room  = need + need / 2 + 1024;
    uint32_t *const other = realloc(list->other, room * sizeof *other);
    if (other == NULL) {
        return DIG_ENOMEM;
    }
    list->other = other;
    list->room  = room;
    return DIG_OK;
}

// A grain as the search reads it, stored cell by cell.
struct cell_grain {
    double   x_m[3], radius_m, margin_m;
    uint32_t grain, clump;
};

static struct cell_grain make_cell_grain(const struct dig_grains *const grains,
                                         const double margin_m[], const uint32_t i)
{
    const double *const x = grains->motion[i].x_m;
    return (struct cell_grain){
        .x_m      = { x[0], x[1], x[2] },
        .radius_m = grains->type[grains->type_of[i]].radius_m,
        .margin_m = margin_m[i],
        .grain    = i,
        .clump    = grains->clump == NULL ? 0 : grains->clump[i],
    };
}

// The search around one grain, or around its image beyond a periodic side.
struct query {
    const struct cell_grain *all; // in the order of the grid's members
    double                   radius_max_m;
    double                   half_m; // of the period: farther images in y are not the nearest
    struct cell_grain        own;
    double                   x_m[3]; // of the grain, or of its image
};

// Whether a near grain is listed under the query's. The grain with the larger margin searches far
// enough to find the pair.
static bool is_listed(const struct query *const q, const struct cell_grain *const other,
                      const double dy_m)
{
    const struct cell_grain *const own      = &q->own;
    const bool                     is_first = other->margin_m < own->margin_m ||
                          (!(other->margin_m > own->margin_m) && other->grain > own->grain);
    const bool apart = own->clump == 0 || own->clump != other->clump;
    return is_first && apart && dy_m >= -q->half_m && dy_m < q->half_m;
}

// The pairs of the query's grain, appended at *used.
static enum dig_status search(const struct query *const q, const struct grid *const g,
                              struct dig_neighbours *const list, size_t *const used)
{
    const double *const x     = q->x_m;
    const double        own_m = q->own.radius_m + q->own.margin_m;
    const double        far_m = q->own.radius_m + q->radius_max_m + 2.0 * q->own.margin_m;
    size_t              count = *used;
    ptrdiff_t           low[3];
    ptrdiff_t           high[3];
    for (int a = 0; a < 3; a++) {
        low[a]  = clamp_cell(g, a, x[a] - far_m);
        high[a] = clamp_cell(g, a, x[a] + far_m);
    }
    const int a = g->axis[0];
    const int b = g->axis[1];
    const int c = g->axis[2];
    for (ptrdiff_t ic = low[c]; ic <= high[c]; ic++) {
        for (ptrdiff_t ib = low[b]; ib <= high[b]; ib++) {
            const size_t row   = (size_t)(g->count[a] * (ib + g->count[b] * ic));
            const size_t first = g->start[row + (size_t)low[a]];
            const size_t last  = g->start[row + (size_t)high[a] + 1];
            if (make_room(list, count + (last - first)) != DIG_OK) {
                return DIG_ENOMEM;
            }
            for (size_t k = first; k < last; k++) {
                const struct cell_grain *const y = &q->all[k];
                const double d[3]    = { x[0] - y->x_m[0], x[1] - y->x_m[1], x[2] - y->x_m[2] };
                const double reach_m = own_m + y->radius_m + y->margin_m;
                if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m &&
                    is_listed(q, y, d[1])) {
                    list->other[count++] = y->grain;
                }
            }
        }
    }
    *used = count;
    return DIG_OK;
}

// Searches around the grain, and around its images where y is periodic.
static enum dig_status search_images(struct query *const q, const struct grid *const g,
                                     const double period_m, struct dig_neighbours *const list,
                                     size_t *const used)
{
    memcpy(q->x_m, q->own.x_m, sizeof q->x_m);
    enum dig_status status = search(q, g, list, used);
    for (int side = -1; period_m > 0.0 && side <= 1 && status == DIG_OK; side += 2) {
        q->x_m[1] = q->own.x_m[1] + side * period_m;
        status    = search(q, g, list, used);
    }
    return status;
}

enum dig_status dig_neighbours_build(const struct dig_grains *const grains, const double period_y_m,
                                     const double margin_m[], struct dig_neighbours *const list)
{
    const size_t n = grains->n;
    if (list->n != n || list->start == NULL) {
        free(list->start);
        free(list->reference_m);
        list->start       = calloc(n + 1, sizeof *list->start);
        list->reference_m = calloc(n + 1, sizeof *list->reference_m);
        list->n           = n;
        if (list->start == NULL || list->reference_m == NULL) {
            dig_neighbours_finish(list);
            return DIG_ENOMEM;
        }
    }
    if (n == 0) {
        return DIG_OK;
    }

    // Cells as wide as the reach of a resting pair: most grains then search 27 cells.
    double radius_max_m = 0.0;
    double margin_min_m = INFINITY;
    for (size_t i = 0; i < n; i++) {
        radius_max_m = fmax(radius_max_m, grains->type[grains->type_of[i]].radius_m);
        margin_min_m = fmin(margin_min_m, margin_m[i]);
        memcpy(list->reference_m[i], grains->motion[i].x_m, 3 * sizeof(double));
        list->reference_m[i][3] = margin_m[i];
    }
    struct grid     g;
    enum dig_status status = fill_grid(grains, 2.0 * (radius_max_m + margin_min_m), &g);
    if (status != DIG_OK) {
        dig_neighbours_finish(list);
        return status;
    }
    struct cell_grain *const cell_grain = malloc((n + 1) * sizeof *cell_grain);
    if (cell_grain == NULL) {
        status = DIG_ENOMEM;
        goto done;
    }
    for (size_t k = 0; k < n; k++) {
        cell_grain[k] = make_cell_grain(grains, margin_m, g.member[k]);
    }
    struct query q = {
        .all          = cell_grain,
        .radius_max_m = radius_max_m,
        .half_m       = period_y_m > 0.0 ? 0.5 * period_y_m : (double)INFINITY,
    };
    size_t used = 0;
    for (size_t i = 0; i < n && status == DIG_OK; i++) {
        list->start[i] = (uint32_t)used;
        q.own          = make_cell_grain(grains, margin_m, (uint32_t)i);
        status         = search_images(&q, &g, period_y_m, list, &used);
    }
    list->start[n] = (uint32_t)used;

done:
    free(cell_grain);
    free(g.start);
    free(g.member);
    if (status != DIG_OK) {
        dig_neighbours_finish(list);
    }
    return status;
}

void dig_neighbours_finish(struct dig_neighbours *const list)
{
    if (list == NULL) {
        return;
    }
    free(list->start);
    free(list->other);
    free(list->reference_m);
    *list = (struct dig_neighbours){ 0 };
}
