#include "offline_dem/world/device_arrays.h"

#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/bodies.h"

#include <stdlib.h>
#include <string.h>

#define CACHE_LINE ((size_t)64) // bytes

enum dig_status dig_device_arrays_init(struct dig_device_arrays *const arrays)
{
    *arrays = (struct dig_device_arrays){ .view.margin_flag = calloc(
                                              DIG_MARGIN_FLAGS, sizeof *arrays->view.margin_flag) };
    return arrays->view.margin_flag != NULL ? DIG_OK : DIG_ENOMEM;
}

void dig_device_arrays_finish(struct dig_device_arrays *const arrays)
{
    free(arrays->memory);
    free(arrays->view.margin_flag);
    *arrays = (struct dig_device_arrays){ .memory = NULL };
}

// Replaces arrays that are too short: one block of memory, in which each is aligned to a cache
// line. Their contents have been downloaded.
static enum dig_status make_room(struct dig_device_arrays *const o, const size_t grains,
                                 const size_t pairs)
{
    struct dig_device_view *const v = &o->view;
    if (o->grain_room > grains && o->surface_room >= v->surfaces && o->pair_room > pairs) {
        return DIG_OK;
    }
    enum { ARRAYS = 10 };
    const size_t n             = grains + 1;
    const size_t p             = pairs + pairs / 8 + 1;
    const size_t bytes[ARRAYS] = {
        n * sizeof *v->load_start,   v->surfaces * n * sizeof *v->surface_history,
        n * sizeof *v->surface_mask, n * sizeof *v->surface_load,
        n * sizeof *v->on_tool,      p * sizeof *v->pair_i,
        p * sizeof *v->load_index,   p * sizeof *v->pair_history,
        2 * p * sizeof *v->touching, 2 * p * sizeof *v->pair_load,
    };
    size_t at[ARRAYS + 1] = { 0 };
    for (size_t a = 0; a < ARRAYS; a++) {
        at[a + 1] = at[a] + (bytes[a] + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    }
    free(o->memory);
    unsigned char *const block = aligned_alloc(CACHE_LINE, at[ARRAYS]);
    o->memory                  = block;
    o->grain_room              = block != NULL ? n : 0;
    if (block == NULL) {
        return DIG_ENOMEM;
    }
    o->surface_room    = v->surfaces;
    o->pair_room       = p;
    v->load_start      = (void *)(block + at[0]);
    v->surface_history = (void *)(block + at[1]);
    v->surface_mask    = (void *)(block + at[2]);
    v->surface_load    = (void *)(block + at[3]);
    v->on_tool         = (void *)(block + at[4]);
    v->pair_i          = (void *)(block + at[5]);
    v->load_index      = (void *)(block + at[6]);
    v->pair_history    = (void *)(block + at[7]);
    v->touching        = (void *)(block + at[8]);
    v->pair_load       = (void *)(block + at[9]);
    return DIG_OK;
}

// What the members of a crew copy from a world to a view.
struct copy {
    struct dig_world             *world;
    const struct dig_device_view *view;
    const struct dig_contacts    *list; // written
};

// Loads on a grain stand in a row, in the order of its pairs in the neighbour list: every device
// adds them in this order. A member goes through all pairs for the loads on its own grains; but
// pairs of grains far from these in memory are none of theirs.
struct range {
    uint32_t first, end;
};

static struct range pairs_around(const struct copy *const c, const size_t first, const size_t end)
{
    const struct dig_neighbours *const near = &c->world->neighbours;
    const size_t                       n    = c->view->n;
    return (struct range){ near->start[first > near->reach ? first - near->reach : 0],
                           near->start[n - end > near->reach ? end + near->reach : n] };
}

static void count_loads(void *const context, const size_t first, const size_t end)
{
    const struct copy *const            c     = context;
    const struct dig_neighbours *const  near  = &c->world->neighbours;
    const struct dig_device_view *const v     = c->view;
    uint32_t *const                     count = v->load_start + 1;
    for (size_t i = first; i < end; i++) {
        count[i] = near->start[i + 1] - near->start[i];
        for (uint32_t p = near->start[i]; p < near->start[i + 1]; p++) {
            v->pair_i[p] = (uint32_t)i;
        }
    }
    const struct range around = pairs_around(c, first, end);
    for (uint32_t p = around.first; p < around.end; p++) {
        if (v->pair_j[p] >= first && v->pair_j[p] < end) {
            count[v->pair_j[p]]++;
        }
    }
}

// Every start ends where the next grain's loads begin.
static void place_loads(void *const context, const size_t first, const size_t end)
{
    const struct dig_device_view *const v      = ((const struct copy *)context)->view;
    uint32_t *const                     next   = v->load_start;
    const struct range                  around = pairs_around(context, first, end);
    for (uint32_t p = around.first; p < around.end; p++) {
        if (v->pair_i[p] >= first && v->pair_i[p] < end) {
            v->load_index[p][0] = next[v->pair_i[p]]++;
        }
        if (v->pair_j[p] >= first && v->pair_j[p] < end) {
            v->load_index[p][1] = next[v->pair_j[p]]++;
        }
    }
}

static void index_loads(struct copy *const c)
{
    const struct dig_device_view *const v     = c->view;
    uint32_t *const                     start = v->load_start;
    dig_crew_each(c->world->crew, v->n, count_loads, c);
    start[0] = 0;
    for (uint32_t i = 0; i < v->n; i++) {
        start[i + 1] += start[i];
    }
    dig_crew_each(c->world->crew, v->n, place_loads, c);
    memmove(start + 1, start, v->n * sizeof *start);
    start[0] = 0;
}

static void clear_pairs(void *const context, const size_t first, const size_t end)
{
    const struct dig_device_view *const v = ((const struct copy *)context)->view;
    memset(v->pair_history + first, 0, (end - first) * sizeof *v->pair_history);
    memset(v->touching + 2 * first, 0, 2 * (end - first) * sizeof *v->touching);
}

static void write_contacts(void *const context, const size_t first, const size_t end)
{
    const struct copy *const            copy = context;
    const struct dig_contacts *const    list = copy->list;
    const struct dig_device_view *const v    = copy->view;
    for (size_t c = first; c < end; c++) {
        const uint32_t p = list->slot[c];
        if (p != UINT32_MAX) {
            v->pair_history[p] = dig_contact_history_times(dig_contacts_history(list, c),
                                                           v->pair_i[p] == list->i[c] ? 1.0 : -1.0);
            v->touching[v->load_index[p][0]] = 1;
            v->touching[v->load_index[p][1]] = 1;
        }
    }
}

static void write_pairs(struct copy *const copy)
{
    struct dig_crew *const crew = copy->world->crew;
    dig_crew_each(crew, copy->view->pairs, clear_pairs, copy);
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        copy->list = &copy->world->pair[l];
        if (copy->list->n > 0) {
            dig_crew_each(crew, copy->list->n, write_contacts, copy);
        }
    }
}

// A wall or a tool that is gone touches nothing.
static void write_list(const struct dig_world *const w, const struct dig_contacts *const list,
                       const struct dig_device_view *const v)
{
    for (size_t c = 0; c < list->n; c++) {
        const uint32_t i = list->i[c];
        const size_t   s = dig_world_surface(w, list->j[c]);
        if (s < v->surfaces) {
            v->surface_history[s * v->n + i] = dig_contacts_history(list, c);
            v->surface_mask[i] |= (uint64_t)1 << s;
        }
    }
}

static void clear_surfaces(void *const context, const size_t first, const size_t end)
{
    const struct dig_device_view *const v = ((const struct copy *)context)->view;
    for (uint32_t s = 0; s < v->surfaces; s++) {
        memset(v->surface_history + (size_t)s * v->n + first, 0,
               (end - first) * sizeof *v->surface_history);
    }
    memset(v->surface_mask + first, 0, (end - first) * sizeof *v->surface_mask);
}

static void write_surfaces(struct copy *const copy)
{
    const struct dig_world *const w = copy->world;
    dig_crew_each(w->crew, copy->view->n, clear_surfaces, copy);
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        write_list(w, &w->surface[l], copy->view);
    }
}

// Laws for both orders of two types.
static void write_laws(const struct dig_world *const w, struct dig_law pair_law[])
{
    for (size_t a = 0; a < w->grains.types; a++) {
        for (size_t b = a; b < w->grains.types; b++) {
            const struct dig_law law              = w->pair_law[a * DIG_GRAIN_TYPES_MAX + b];
            struct dig_law       swapped          = law;
            swapped.lever_i_m                     = law.lever_j_m;
            swapped.lever_j_m                     = law.lever_i_m;
            pair_law[a * DIG_GRAIN_TYPES_MAX + b] = law;
            pair_law[b * DIG_GRAIN_TYPES_MAX + a] = swapped;
        }
    }
}

enum dig_status dig_device_arrays_write_lists(struct dig_world *const         w,
                                              struct dig_device_arrays *const arrays)
{
    const size_t                  n     = w->grains.n;
    const size_t                  pairs = w->neighbours.start[n];
    struct dig_device_view *const v     = &arrays->view;
    v->walls                            = (uint32_t)w->walls;
    v->plates                           = w->tool == NULL ? 0 : (uint32_t)w->tool->plates;
    v->surfaces                         = v->walls + v->plates;
    if (w->bodies != NULL) {
        v->clumps = (uint32_t)w->bodies->clumps;
        v->clump  = w->bodies->clump;
        v->shape  = &w->bodies->shape;
        v->surfaces += (uint32_t)w->bodies->obstacles.rocks;
    }
    const enum dig_status status = make_room(arrays, n, pairs);
    if (status != DIG_OK) {
        return status;
    }
    v->n             = (uint32_t)n;
    v->pairs         = (uint32_t)pairs;
    v->type_of       = w->grains.type_of;
    v->reference_m   = (const double(*)[4])w->neighbours.reference_m;
    v->pair_j        = w->neighbours.other;
    v->pair_start    = w->neighbours.start;
    v->pair_law      = arrays->pair_law;
    v->wall_law      = w->wall_law;
    v->tool_law      = w->tool_law;
    v->type          = w->grains.type;
    v->motion        = w->grains.motion;
    struct copy copy = { .world = w, .view = v };
    index_loads(&copy);
    write_laws(w, arrays->pair_law);
    memset(v->on_tool, 0, n * sizeof *v->on_tool);
    memset(v->margin_flag, 0, DIG_MARGIN_FLAGS * sizeof *v->margin_flag);
    return DIG_OK;
}

enum dig_status dig_device_arrays_write(struct dig_world *const         w,
                                        struct dig_device_arrays *const arrays)
{
    const enum dig_status status = dig_device_arrays_write_lists(w, arrays);
    if (status == DIG_OK) {
        struct copy copy = { .world = w, .view = &arrays->view };
        write_pairs(&copy);
        write_surfaces(&copy);
    }
    return status;
}
