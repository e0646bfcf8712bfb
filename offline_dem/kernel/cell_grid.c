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

// What a member of a crew finds: the box around its grains, and how many grains are in its cells.
struct share {
    double low_m[3], high_m[3];
    size_t in_cells;
};

// A grid that a crew fills.
struct filling {
    const struct dig_grains *grains;
    struct dig_crew         *crew;
    struct dig_cell_grid    *grid;
    uint32_t                *cell;  // [n] of each grain
    struct share            *share; // [members]
};

static void find_box(void *const context, const size_t member)
{
    const struct filling *const f   = context;
    const size_t                end = dig_crew_share(f->crew, f->grains->n, member + 1);
    struct share box = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY }, 0 };
    for (size_t i = dig_crew_share(f->crew, f->grains->n, member); i < end; i++) {
        for (int a = 0; a < 3; a++) {
            const double x_m = f->grains->motion[i].x_m[a];
            box.low_m[a]     = x_m < box.low_m[a] ? x_m : box.low_m[a];
            box.high_m[a]    = x_m > box.high_m[a] ? x_m : box.high_m[a];
        }
    }
    f->share[member] = box;
}

static void size_grid(const struct filling *const f)
{
    struct dig_cell_grid *const g         = f->grid;
    double                      high_m[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int a = 0; a < 3; a++) {
        g->low_m[a] = INFINITY;
        for (size_t m = 0; m < dig_crew_members(f->crew); m++) {
            g->low_m[a] = fmin(g->low_m[a], f->share[m].low_m[a]);
            high_m[a]   = fmax(high_m[a], f->share[m].high_m[a]);
        }
    }
    const double most = (double)(CELLS_PER_GRAIN * f->grains->n + 64);
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

static void tell_cells(void *const context, const size_t first, const size_t end)
{
    const struct filling *const f = context;
    for (size_t i = first; i < end; i++) {
        f->cell[i] = (uint32_t)cell_of(f->grid, f->grains->motion[i].x_m);
    }
}

// A member looks at every grain for those in its cells, so that they stay in order. start[c + 1] is
// where cell c begins, counted from the member's first.
static void count_in_cells(void *const context, const size_t member)
{
    const struct filling *const f     = context;
    uint32_t *const             start = f->grid->start + 1;
    const size_t                first = dig_crew_share(f->crew, f->grid->cells, member);
    const size_t                end   = dig_crew_share(f->crew, f->grid->cells, member + 1);
    uint32_t                    sum   = 0;
    memset(start + first, 0, (end - first) * sizeof *start);
    for (size_t i = 0; i < f->grains->n; i++) {
        if (f->cell[i] >= first && f->cell[i] < end) {
            start[f->cell[i]]++;
        }
    }
    for (size_t c = first; c < end; c++) {
        const uint32_t grains = start[c];
        start[c]              = sum;
        sum += grains;
    }
    f->share[member].in_cells = sum;
}

// start[c + 1] runs ahead while cell c is filled and ends where cell c + 1 begins.
static void place_in_cells(void *const context, const size_t member)
{
    const struct filling *const f      = context;
    uint32_t *const             start  = f->grid->start + 1;
    const size_t                first  = dig_crew_share(f->crew, f->grid->cells, member);
    const size_t                end    = dig_crew_share(f->crew, f->grid->cells, member + 1);
    size_t                      before = 0;
    for (size_t m = 0; m < member; m++) {
        before += f->share[m].in_cells;
    }
    for (size_t c = first; c < end && before > 0; c++) {
        start[c] += (uint32_t)before;
    }
    for (size_t i = 0; i < f->grains->n; i++) {
        if (f->cell[i] >= first && f->cell[i] < end) {
            f->grid->member[start[f->cell[i]]++] = (uint32_t)i;
        }
    }
}

static enum dig_status fill(struct filling *const f, struct dig_cell_grid *const g)
{
    f->grid = g;
    dig_crew_run(f->crew, find_box, f);
    size_grid(f);
    g->start  = malloc((g->cells + 1) * sizeof *g->start);
    g->member = malloc((f->grains->n + 1) * sizeof *g->member);
    if (g->start == NULL || g->member == NULL) {
        dig_cell_grid_finish(g);
        return DIG_ENOMEM;
    }
    g->start[0] = 0;
    dig_crew_each(f->crew, f->grains->n, tell_cells, f);
    dig_crew_run(f->crew, count_in_cells, f);
    dig_crew_run(f->crew, place_in_cells, f);
    return DIG_OK;
}

enum dig_status dig_cell_grid_fill(const struct dig_grains *const grains, const double cell_m,
                                   struct dig_crew *const crew, struct dig_cell_grid *const g)
{
    struct filling f = {
        .grains = grains,
        .crew   = crew,
        .cell   = malloc((grains->n + 1) * sizeof *f.cell),
        .share  = calloc(dig_crew_members(crew), sizeof *f.share),
    };
    *g                           = (struct dig_cell_grid){ .cell_m = cell_m };
    const enum dig_status status = f.cell != NULL && f.share != NULL ? fill(&f, g) : DIG_ENOMEM;
    free(f.cell);
    free(f.share);
    return status;
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
