#include "offline_dem/kernel/neighbour.h"

#include "offline_dem/kernel/cell_grid.h"
#include "offline_dem/kernel/crew.h"

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

// Whether so far around the query nothing of the grid lies, as around most images.
static bool is_beside(const struct query *const q, const struct dig_cell_grid *const g,
                      const double far_m)
{
    return q->x_m[1] + far_m < g->low_m[1] ||
           q->x_m[1] - far_m > g->low_m[1] + (double)g->count[1] * g->cell_m;
}

static size_t farther(const size_t reach, const size_t i, const size_t j)
{
    const size_t apart = i < j ? j - i : i - j;
    return apart > reach ? apart : reach;
}

// Appends the pairs of the query's grain.
static enum dig_status search(const struct query *const q, const struct dig_cell_grid *const g,
                              struct finds *const finds)
{
    const double *const x     = q->x_m;
    const double        own_m = q->own.radius_m + q->own.margin_m;
    const double        far_m = q->own.radius_m + q->radius_max_m + 2.0 * q->own.margin_m;
    size_t              count = finds->used;
    size_t              reach = finds->reach;
    ptrdiff_t           low[3];
    ptrdiff_t           high[3];
    if (is_beside(q, g, far_m)) {
        return DIG_OK;
    }
    for (int a = 0; a < 3; a++) {
        low[a]  = dig_cell_grid_along(g, a, x[a] - far_m);
        high[a] = dig_cell_grid_along(g, a, x[a] + far_m);
    }
    const int a = g->axis[0];
    const int b = g->axis[1];
    const int c = g->axis[2];
    for (ptrdiff_t ic = low[c]; ic <= high[c]; ic++) {
        for (ptrdiff_t ib = low[b]; ib <= high[b]; ib++) {
            const size_t row   = (size_t)(g->count[a] * (ib + g->count[b] * ic));
            const size_t first = g->start[row + (size_t)low[a]];
            const size_t last  = g->start[row + (size_t)high[a] + 1];
            if (make_room(finds, count + (last - first)) != DIG_OK) {
                return DIG_ENOMEM;
            }
            for (size_t k = first; k < last; k++) {
                const struct cell_grain *const y = &q->all[k];
                const double d[3]    = { x[0] - y->x_m[0], x[1] - y->x_m[1], x[2] - y->x_m[2] };
                const double reach_m = own_m + y->radius_m + y->margin_m;
                if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m &&
                    is_listed(q, y, d[1])) {
                    finds->other[count++] = y->grain;
                    reach                 = farther(reach, q->own.grain, y->grain);
                }
            }
        }
    }
    finds->used  = count;
    finds->reach = reach;
    return DIG_OK;
}

// Searches around the grain, and around its images where y is periodic: most are out of reach.
static enum dig_status search_images(struct query *const q, const struct dig_cell_grid *const g,
                                     const double period_m, struct finds *const finds)
{
    memcpy(q->x_m, q->own.x_m, sizeof q->x_m);
    enum dig_status status = search(q, g, finds);
    for (int side = -1; period_m > 0.0 && side <= 1 && status == DIG_OK; side += 2) {
        q->x_m[1] = q->own.x_m[1] + side * period_m;
        status    = search(q, g, finds);
    }
    return status;
}

// A search that a crew shares. Each member finds the pairs of its grains.
struct shared_search {
    const struct dig_grains *grains;
    const double            *margin_m;
    double                   period_m, radius_max_m;
    struct dig_cell_grid     grid;
    struct cell_grain       *cell_grain; // [n] in the order of the grid's members
    struct dig_crew         *crew;
    struct finds            *finds; // [members]
    struct dig_neighbours   *list;
};

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
    const struct shared_search *const s = context;
    for (size_t k = first; k < end; k++) {
        s->cell_grain[k] = make_cell_grain(s->grains, s->margin_m, s->grid.member[k]);
    }
}

static void search_share(void *const context, const size_t member)
{
    const struct shared_search *const s     = context;
    struct finds *const               finds = &s->finds[member];
    const size_t                      end   = dig_crew_share(s->crew, s->grains->n, member + 1);
    struct query                      q     = {
                                 .all          = s->cell_grain,
                                 .radius_max_m = s->radius_max_m,
                                 .half_m = s->period_m > 0.0 ? 0.5 * s->period_m : (double)INFINITY,
    };
    for (size_t i = dig_crew_share(s->crew, s->grains->n, member);
         i < end && finds->status == DIG_OK; i++) {
        s->list->start[i] = (uint32_t)finds->used; // from the member's first
        q.own             = make_cell_grain(s->grains, s->margin_m, (uint32_t)i);
        finds->status     = search_images(&q, &s->grid, s->period_m, finds);
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
    s->cell_grain = malloc((n + 1) * sizeof *s->cell_grain);
    if (s->cell_grain == NULL) {
        status = DIG_ENOMEM;
    } else {
        dig_crew_each(s->crew, n, order_by_cells, s);
        status = find_pairs(s);
    }
    free(s->cell_grain);
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
