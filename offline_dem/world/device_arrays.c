#include "offline_dem/world/device_arrays.h"

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
    free(arrays->grains);
    free(arrays->pairs);
    free(arrays->view.margin_flag);
    *arrays = (struct dig_device_arrays){ .grains = NULL };
}

// One block of memory for several arrays of so many bytes, each aligned to a cache line; NULL when
// memory is short.
static void *allocate(const size_t arrays, const size_t bytes[], void *array[])
{
    size_t sum = 0;
    for (size_t a = 0; a < arrays; a++) {
        sum += (bytes[a] + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    }
    unsigned char *const block = aligned_alloc(CACHE_LINE, sum);
    unsigned char       *next  = block;
    for (size_t a = 0; a < arrays && block != NULL; a++) {
        array[a] = next;
        next += (bytes[a] + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    }
    return block;
}

// Replaces arrays that are too short. Their contents have been downloaded.
static enum dig_status make_grains_room(struct dig_device_arrays *const o, const size_t n)
{
    struct dig_device_view *const v       = &o->view;
    const size_t                  bytes[] = {
                         (n + 1) * sizeof *v->load_start,
                         DIG_DEVICE_SURFACES * (n + 1) * sizeof *v->surface_history,
                         (n + 1) * sizeof *v->surface_mask,
                         (n + 1) * sizeof *v->surface_load,
                         (n + 1) * sizeof *v->on_tool,
    };
    void *array[5] = { NULL };
    free(o->grains);
    o->grains          = allocate(5, bytes, array);
    o->grain_room      = o->grains != NULL ? n + 1 : 0;
    v->load_start      = array[0];
    v->surface_history = array[1];
    v->surface_mask    = array[2];
    v->surface_load    = array[3];
    v->on_tool         = array[4];
    return o->grains != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_pairs_room(struct dig_device_arrays *const o, const size_t pairs)
{
    struct dig_device_view *const v       = &o->view;
    const size_t                  room    = pairs + pairs / 8 + 1;
    const size_t                  bytes[] = {
                         room * sizeof *v->pair_i,        room * sizeof *v->load_index,
                         room * sizeof *v->pair_history,  2 * room * sizeof *v->touching,
                         2 * room * sizeof *v->pair_load,
    };
    void *array[5] = { NULL };
    free(o->pairs);
    o->pairs        = allocate(5, bytes, array);
    o->pair_room    = o->pairs != NULL ? room : 0;
    v->pair_i       = array[0];
    v->load_index   = array[1];
    v->pair_history = array[2];
    v->touching     = array[3];
    v->pair_load    = array[4];
    return o->pairs != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_room(struct dig_device_arrays *const o, const size_t n,
                                 const size_t pairs)
{
    enum dig_status status = o->grain_room < n + 1 ? make_grains_room(o, n) : DIG_OK;
    if (status == DIG_OK && o->pair_room < pairs + 1) {
        status = make_pairs_room(o, pairs);
    }
    return status;
}

// Loads on a grain stand in a row, in the order of its pairs in the neighbour list: every device
// adds them in this order.
static void index_loads(const struct dig_neighbours *const near, struct dig_device_view *const v)
{
    uint32_t *const first = v->load_start;
    uint32_t *const row   = v->pair_i;
    memset(first, 0, (v->n + 1) * sizeof *first);
    for (uint32_t i = 0; i < v->n; i++) {
        for (uint32_t p = near->start[i]; p < near->start[i + 1]; p++) {
            row[p] = i;
            first[i]++;
            first[near->other[p]]++;
        }
    }
    uint32_t sum = 0;
    for (uint32_t i = 0; i <= v->n; i++) {
        const uint32_t count = first[i];
        first[i]             = sum;
        sum += count;
    }
    // Filling moves every start to its end, which is the next start.
    for (uint32_t p = 0; p < v->pairs; p++) {
        v->load_index[p][0] = first[row[p]]++;
        v->load_index[p][1] = first[near->other[p]]++;
    }
    memmove(first + 1, first, v->n * sizeof *first);
    first[0] = 0;
}

static struct dig_contact_history load_history(const struct dig_contacts *const list,
                                               const size_t c, const double sign)
{
    double *const *const m = list->history;
    return (struct dig_contact_history){ sign * m[0][c], sign * m[1][c], sign * m[2][c],
                                         sign * m[3][c], sign * m[4][c], sign * m[5][c] };
}

static void write_pairs(const struct dig_world *const w, const struct dig_device_view *const v)
{
    memset(v->pair_history, 0, v->pairs * sizeof *v->pair_history);
    memset(v->touching, 0, 2 * (size_t)v->pairs * sizeof *v->touching);
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        const struct dig_contacts *const list = &w->pair[l];
        for (size_t c = 0; c < list->n; c++) {
            const uint32_t p = list->slot[c];
            if (p != UINT32_MAX) {
                v->pair_history[p] = load_history(list, c, v->pair_i[p] == list->i[c] ? 1.0 : -1.0);
                v->touching[v->load_index[p][0]] = 1;
                v->touching[v->load_index[p][1]] = 1;
            }
        }
    }
}

// Contacts of one list with surfaces; surface j of the list has number first + j.
static void write_list(const struct dig_contacts *const list, const uint32_t first,
                       const struct dig_device_view *const v)
{
    for (size_t c = 0; c < list->n; c++) {
        const uint32_t i                         = list->i[c];
        const uint32_t s                         = first + list->j[c];
        v->surface_history[(size_t)s * v->n + i] = load_history(list, c, 1.0);
        v->surface_mask[i] |= (uint64_t)1 << s;
    }
}

static void write_surfaces(const struct dig_world *const w, const struct dig_device_view *const v)
{
    memset(v->surface_history, 0, v->surface_rows * (size_t)v->n * sizeof *v->surface_history);
    memset(v->surface_mask, 0, v->n * sizeof *v->surface_mask);
    for (size_t k = 0; k < DIG_GRAIN_TYPES_MAX; k++) {
        write_list(&w->surface[k], 0, v);
        write_list(&w->surface[DIG_GRAIN_TYPES_MAX + k], DIG_WALLS_MAX - (uint32_t)w->walls, v);
        if (w->bodies != NULL) {
            write_list(&w->bodies->obstacles.contact[k], DIG_DEVICE_ROCKS, v);
        }
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

enum dig_status dig_device_arrays_write(const struct dig_world *const   w,
                                        struct dig_device_arrays *const arrays)
{
    const size_t          n      = w->grains.n;
    const size_t          pairs  = w->neighbours.start[n];
    const enum dig_status status = make_room(arrays, n, pairs);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_device_view *const v = &arrays->view;
    v->n                            = (uint32_t)n;
    v->pairs                        = (uint32_t)pairs;
    v->type_of                      = w->grains.type_of;
    v->reference_m                  = (const double(*)[4])w->neighbours.reference_m;
    v->pair_j                       = w->neighbours.other;
    v->pair_law                     = arrays->pair_law;
    v->wall_law                     = w->wall_law;
    v->tool_law                     = w->tool_law;
    v->type                         = w->grains.type;
    v->motion                       = w->grains.motion;
    v->surface_rows                 = DIG_DEVICE_ROCKS;
    if (w->bodies != NULL) {
        v->clumps = (uint32_t)w->bodies->clumps;
        v->clump  = w->bodies->clump;
        v->shape  = &w->bodies->shape;
        v->surface_rows += (uint32_t)w->bodies->obstacles.rocks;
    }
    index_loads(&w->neighbours, v);
    write_laws(w, arrays->pair_law);
    write_pairs(w, v);
    write_surfaces(w, v);
    memset(v->on_tool, 0, n * sizeof *v->on_tool);
    memset(v->margin_flag, 0, DIG_MARGIN_FLAGS * sizeof *v->margin_flag);
    return DIG_OK;
}

static enum dig_status append_history(struct dig_contacts *const list, const uint32_t i,
                                      const uint32_t                          j,
                                      const struct dig_contact_history *const history,
                                      const double                            sign)
{
    const enum dig_status status = dig_contacts_add(list, i, j, UINT32_MAX, NULL, 0);
    if (status == DIG_OK) {
        const double m[DIG_HISTORY_VALUES] = { history->sx_m,  history->sy_m,  history->sz_m,
                                               history->mx_Nm, history->my_Nm, history->mz_Nm };
        for (int k = 0; k < DIG_HISTORY_VALUES; k++) {
            list->history[k][list->n - 1] = sign * m[k];
        }
    }
    return status;
}

static enum dig_status read_pairs(const struct dig_device_view *const v, struct dig_world *const w)
{
    enum dig_status status = DIG_OK;
    for (uint32_t p = 0; p < v->pairs && status == DIG_OK; p++) {
        if (v->touching[v->load_index[p][0]] == 0) {
            continue;
        }
        const uint32_t i = v->pair_i[p];
        const uint32_t j = v->pair_j[p];
        const size_t   a = v->type_of[i];
        const size_t   b = v->type_of[j];
        status           = a <= b ? append_history(&w->pair[a * DIG_GRAIN_TYPES_MAX + b], i, j,
                                                   &v->pair_history[p], 1.0)
                                  : append_history(&w->pair[b * DIG_GRAIN_TYPES_MAX + a], j, i,
                                                   &v->pair_history[p], -1.0);
    }
    return status;
}

static enum dig_status read_surfaces(const struct dig_device_view *const v,
                                     struct dig_world *const             w)
{
    enum dig_status status = DIG_OK;
    for (uint32_t i = 0; i < v->n; i++) {
        for (uint32_t s = 0;
             s < v->surface_rows && v->surface_mask[i] >> s != 0 && status == DIG_OK; s++) {
            if ((v->surface_mask[i] >> s & 1) == 0) {
                continue;
            }
            const struct dig_contact_history *const history =
                &v->surface_history[(size_t)s * v->n + i];
            const size_t type = v->type_of[i];
            if (s < DIG_WALLS_MAX) {
                status = append_history(&w->surface[type], i, s, history, 1.0);
            } else if (s < DIG_DEVICE_ROCKS) {
                status = append_history(&w->surface[DIG_GRAIN_TYPES_MAX + type], i,
                                        (uint32_t)w->walls + s - DIG_WALLS_MAX, history, 1.0);
            } else {
                status = append_history(&w->bodies->obstacles.contact[type], i,
                                        s - DIG_DEVICE_ROCKS, history, 1.0);
            }
        }
    }
    return status;
}

static void clear_lists(struct dig_world *const w)
{
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        w->pair[l].n = 0;
    }
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        w->surface[l].n = 0;
    }
    for (size_t k = 0; k < DIG_GRAIN_TYPES_MAX && w->bodies != NULL; k++) {
        w->bodies->obstacles.contact[k].n = 0;
    }
}

enum dig_status dig_device_arrays_read(const struct dig_device_arrays *const arrays,
                                       struct dig_world *const               w)
{
    clear_lists(w);
    const enum dig_status status = read_pairs(&arrays->view, w);
    return status == DIG_OK ? read_surfaces(&arrays->view, w) : status;
}
