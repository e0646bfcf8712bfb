#include "offline_dem/kernel/neighbour.h"

#include "offline_dem/kernel/cell_grid.h"
#include "offline_dem/kernel/crew.h"
#include "offline_dem/kernel/kernel.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer loses sight of what a member of a crew has found.
#pragma GCC diagnostic ignored "-Wanalyzer-malloc-leak"
#endif

// The pairs that one member of a crew has found, and what it has seen of its grains.
struct finds {
    double          radius_max_m, margin_min_m;
    uint32_t       *other;
    size_t          used, room;
    size_t          reach;
    enum dig_status status;
};

static enum dig_status make_room(struct finds *const finds, const size_t need)
{
    if (need <= finds->room) {
        return DIG_OK;
    }
    const size_t    room  = need + need / 2 + 1024;
    uint32_t *const other = realloc(finds->other, room * sizeof *other);
    if (other == NULL) {
        return DIG_ENOMEM;
    }
    finds->other = other;
    finds->room  = room;
    return DIG_OK;
}

// Rows of cells that are searched at once: as a rule nine.
#define ROWS 32

// The search around one grain, or around its image beyond a periodic side.
struct query {
    struct dig_near_query near;
    double                far_m; // no pair of the grain's is longer
};

// Whether so far around the query nothing of the grid lies, as around most images.
static bool is_beside(const struct query *const q, const struct dig_cell_grid *const g)
{
    return q->near.x_m[1] + q->far_m < g->low_m[1] ||
           q->near.x_m[1] - q->far_m > g->low_m[1] + (double)g->count[1] * g->cell_m;
}

// Leaves out those of the grain's own clump.
static size_t drop_own_clump(const uint32_t clump[], const uint32_t i, const size_t count,
                             uint32_t other[])
{
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        other[kept] = other[k];
        kept += clump[i] == 0 || clump[i] != clump[other[k]];
    }
    return kept;
}

static size_t farthest(const size_t reach, const size_t i, const size_t count,
                       const uint32_t other[])
{
    size_t most = reach;
    for (size_t k = 0; k < count; k++) {
        const size_t apart = i < other[k] ? other[k] - i : i - other[k];
        most               = apart > most ? apart : most;
    }
    return most;
}

// A search that a crew shares. Each member finds the pairs of its grains.
struct shared_search {
    const struct dig_grains *grains;
    const double            *margin_m;
    double                   period_m, radius_max_m;
    enum dig_isa             isa;
    struct dig_cell_grid     grid;
    struct dig_near_grains   in_cells; // [n] in the order of the grid's members
    struct dig_crew         *crew;
    struct finds            *finds; // [members]
    struct dig_neighbours   *list;
};

// The arrays of doubles are one piece of memory.
static enum dig_status make_in_cells(const size_t n, struct dig_near_grains *const in)
{
    const size_t  room = n + DIG_NEAR_PADDING;
    double *const x_m  = calloc(5 * room, sizeof *x_m);
    in->x_m            = x_m;
    in->grain          = calloc(room, sizeof *in->grain);
    if (x_m == NULL || in->grain == NULL) {
        return DIG_ENOMEM;
    }
    in->y_m      = x_m + room;
    in->z_m      = x_m + 2 * room;
    in->radius_m = x_m + 3 * room;
    in->margin_m = x_m + 4 * room;
    return DIG_OK;
}

static void look_at_grains(void *const context, const size_t member)
{
    const struct shared_search *const s      = context;
    const struct dig_grains *const    grains = s->grains;
    const size_t                      end    = dig_crew_share(s->crew, grains->n, member + 1);
    struct finds                      seen   = { .margin_min_m = INFINITY };
    for (size_t i = dig_crew_share(s->crew, grains->n, member); i < end; i++) {
        const double  radius_m    = grains->type[grains->type_of[i]].radius_m;
        double *const reference_m = s->list->reference_m[i];
        seen.radius_max_m         = radius_m > seen.radius_max_m ? radius_m : seen.radius_max_m;
        seen.margin_min_m = s->margin_m[i] < seen.margin_min_m ? s->margin_m[i] : seen.margin_min_m;
        memcpy(reference_m, grains->motion[i].x_m, 3 * sizeof(double));
        reference_m[3] = s->margin_m[i];
    }
    s->finds[member] = seen;
}

static void order_by_cells(void *const context, const size_t first, const size_t end)
{
    const struct shared_search *const   s  = context;
    const struct dig_near_grains *const in = &s->in_cells;
    for (size_t k = first; k < end; k++) {
        const uint32_t      i = s->grid.member[k];
        const double *const x = s->grains->motion[i].x_m;
        in->x_m[k]            = x[0];
        in->y_m[k]            = x[1];
        in->z_m[k]            = x[2];
        in->radius_m[k]       = s->grains->type[s->grains->type_of[i]].radius_m;
        in->margin_m[k]       = s->margin_m[i];
        in->grain[k]          = i;
    }
}

// Appends the pairs of the query's grain in these rows, which hold so many grains.
static enum dig_status search_rows(const struct shared_search *const s, const struct query *const q,
                                   const size_t rows, const struct dig_near_row row[],
                                   const size_t grains, struct finds *const finds)
{
    if (make_room(finds, finds->used + grains) != DIG_OK) {
        return DIG_ENOMEM;
    }
    uint32_t *const other = finds->other + finds->used;
    const uint32_t  i     = q->near.grain;
    size_t          count = dig_kernel_near(s->isa, &q->near, &s->in_cells, rows, row, other);
    if (s->grains->clump != NULL) {
        count = drop_own_clump(s->grains->clump, i, count, other);
    }
    finds->reach = farthest(finds->reach, i, count, other);
    finds->used += count;
    return DIG_OK;
}

// Appends the pairs of the query's grain.
static enum dig_status search(const struct shared_search *const s, const struct query *const q,
                              struct finds *const finds)
{
    const struct dig_cell_grid *const g = &s->grid;
    ptrdiff_t                         low[3];
    ptrdiff_t                         high[3];
    if (is_beside(q, g)) {
        return DIG_OK;
    }
    for (int a = 0; a < 3; a++) {
        low[a]  = dig_cell_grid_along(g, a, q->near.x_m[a] - q->far_m);
        high[a] = dig_cell_grid_along(g, a, q->near.x_m[a] + q->far_m);
    }
    const int           a = g->axis[0];
    const int           b = g->axis[1];
    const int           c = g->axis[2];
    struct dig_near_row row[ROWS];
    size_t              rows   = 0;
    size_t              grains = 0;
    enum dig_status     status = DIG_OK;
    for (ptrdiff_t ic = low[c]; ic <= high[c] && status == DIG_OK; ic++) {
        for (ptrdiff_t ib = low[b]; ib <= high[b] && status == DIG_OK; ib++) {
            const size_t first = (size_t)(g->count[a] * (ib + g->count[b] * ic));
            row[rows].first    = g->start[first + (size_t)low[a]];
            row[rows].end      = g->start[first + (size_t)high[a] + 1];
            grains += row[rows].end - row[rows].first;
            if (++rows == ROWS) {
                status = search_rows(s, q, rows, row, grains, finds);
                rows   = 0;
                grains = 0;
            }
        }
    }
    return status == DIG_OK ? search_rows(s, q, rows, row, grains, finds) : status;
}

// Searches around the grain, and around its images where y is periodic: most are out of reach.
static enum dig_status search_images(const struct shared_search *const s, const uint32_t i,
                                     struct finds *const finds)
{
    const double *const x        = s->grains->motion[i].x_m;
    const double        radius_m = s->grains->type[s->grains->type_of[i]].radius_m;
    const double        margin_m = s->margin_m[i];
    struct query        q        = {
                      .near  = { .x_m      = { x[0], x[1], x[2] },
                                 .own_m    = radius_m + margin_m,
                                 .margin_m = margin_m,
                                 .half_m   = s->period_m > 0.0 ? 0.5 * s->period_m : (double)INFINITY,
                                 .grain    = i },
                      .far_m = radius_m + s->radius_max_m + 2.0 * margin_m,
    };
    enum dig_status status = search(s, &q, finds);
    for (int side = -1; s->period_m > 0.0 && side <= 1 && status == DIG_OK; side += 2) {
        q.near.x_m[1] = x[1] + side * s->period_m;
        status        = search(s, &q, finds);
    }
    return status;
}

static void search_share(void *const context, const size_t member)
{
    const struct shared_search *const s     = context;
    struct finds *const               finds = &s->finds[member];
    const size_t                      end   = dig_crew_share(s->crew, s->grains->n, member + 1);
    for (size_t i = dig_crew_share(s->crew, s->grains->n, member);
         i < end && finds->status == DIG_OK; i++) {
        s->list->start[i] = (uint32_t)finds->used; // from the member's first
        finds->status     = search_images(s, (uint32_t)i, finds);
    }
}

// What a member has found moves to its place in the list. The first member's is there.
static void place_share(void *const context, const size_t member)
{
    const struct shared_search *const s    = context;
    size_t                            from = 0;
    for (size_t m = 0; m < member; m++) {
        from += s->finds[m].used;
    }
    const size_t end = dig_crew_share(s->crew, s->grains->n, member + 1);
    for (size_t i = dig_crew_share(s->crew, s->grains->n, member); i < end && from > 0; i++) {
        s->list->start[i] += (uint32_t)from;
    }
    if (member > 0 && s->finds[member].used > 0) {
        memcpy(s->list->other + from, s->finds[member].other,
               s->finds[member].used * sizeof *s->list->other);
    }
}

// Fills the list from what is in cells. The first member finds into the list's own memory.
static enum dig_status find_pairs(struct shared_search *const s)
{
    const size_t members = dig_crew_members(s->crew);
    s->finds[0].other    = s->list->other;
    s->finds[0].room     = s->list->room;
    dig_crew_run(s->crew, search_share, s);
    enum dig_status status = DIG_OK;
    size_t          found  = 0;
    s->list->reach         = 0;
    for (size_t m = 0; m < members; m++) {
        const struct finds *const finds = &s->finds[m];
        found += finds->used;
        status         = finds->status == DIG_OK ? status : finds->status;
        s->list->reach = finds->reach > s->list->reach ? finds->reach : s->list->reach;
    }
    status         = status == DIG_OK ? make_room(&s->finds[0], found) : status;
    s->list->other = s->finds[0].other;
    s->list->room  = s->finds[0].room;
    if (status == DIG_OK) {
        dig_crew_run(s->crew, place_share, s);
        s->list->start[s->grains->n] = (uint32_t)found;
    }
    for (size_t m = 1; m < members; m++) {
        free(s->finds[m].other);
    }
    return status;
}

// Cells as wide as the reach of a resting pair: most grains then search 27 cells.
static enum dig_status build(struct shared_search *const s)
{
    const size_t n            = s->grains->n;
    double       margin_min_m = INFINITY;
    dig_crew_run(s->crew, look_at_grains, s);
    for (size_t m = 0; m < dig_crew_members(s->crew); m++) {
        s->radius_max_m = fmax(s->radius_max_m, s->finds[m].radius_max_m);
        margin_min_m    = fmin(margin_min_m, s->finds[m].margin_min_m);
    }
    enum dig_status status =
        dig_cell_grid_fill(s->grains, 2.0 * (s->radius_max_m + margin_min_m), s->crew, &s->grid);
    if (status != DIG_OK) {
        return status;
    }
    status = make_in_cells(n, &s->in_cells);
    if (status == DIG_OK) {
        dig_crew_each(s->crew, n, order_by_cells, s);
        status = find_pairs(s);
    }
    free(s->in_cells.x_m);
    free(s->in_cells.grain);
    dig_cell_grid_finish(&s->grid);
    return status;
}

enum dig_status dig_neighbours_build(const struct dig_grains *const grains, const double period_y_m,
                                     const double margin_m[], struct dig_crew *const crew,
                                     struct dig_neighbours *const list)
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
    list->reach = 0;
    if (n == 0) {
        return DIG_OK;
    }
    struct shared_search search = {
        .grains   = grains,
        .margin_m = margin_m,
        .period_m = period_y_m,
        .isa      = dig_kernel_best(),
        .crew     = crew,
        .finds    = calloc(dig_crew_members(crew), sizeof *search.finds),
        .list     = list,
    };
    const enum dig_status status = search.finds != NULL ? build(&search) : DIG_ENOMEM;
    free(search.finds);
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
