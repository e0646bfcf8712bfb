#include "offline_dem/world/offloaded.h"

#include "offline_dem/law/period.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/lists.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Wider than the kernel's: a pair costs a device little, a list as much as hundreds of steps.
static const struct dig_skin wide_skin = { 0.5, 500.0, 1.5 };
#define CACHE_LINE       ((size_t)64) // bytes of a cache line
#define POLL_STEPS       16           // between two looks at what the grains call for, and
#define ROCKS_POLL_STEPS 2            // where a grain may be squeezed out between bucket and rock
#define SPEED_RESERVE    2.0          // what a grain may speed up by meanwhile

struct dig_offloaded {
    struct dig_device     *device;
    struct dig_device_view view;
    struct dig_law         law[DIG_DEVICE_LAWS];
    void                  *grain_arrays, *pair_arrays; // the view's arrays of grains, and of pairs
    size_t                 grains_room, pairs_room;
    bool                   is_synced;        // all of the state, contacts in the world's lists
    bool                   is_motion_synced; // motions are those of the last step
    size_t                 unpolled_steps;
};

enum dig_status dig_offload(struct dig_world *const w, struct dig_device *const device)
{
    assert(w != NULL && device != NULL && w->offloaded == NULL);
    assert(w->bodies == NULL || w->bodies->ode == NULL);
    struct dig_offloaded *const o = calloc(1, sizeof *o);
    if (o == NULL) {
        return DIG_ENOMEM;
    }
    o->device           = device;
    o->is_synced        = true;
    o->is_motion_synced = true;
    o->view.margin_flag = calloc(DIG_MARGIN_FLAGS, sizeof *o->view.margin_flag);
    if (o->view.margin_flag == NULL) {
        free(o);
        return DIG_ENOMEM;
    }
    w->offloaded = o;
    w->stale     = true;
    return DIG_OK;
}

void dig_offloaded_destroy(struct dig_offloaded *const o)
{
    if (o != NULL) {
        free(o->grain_arrays);
        free(o->pair_arrays);
        free(o->view.margin_flag);
        free(o);
    }
}

// One block of memory for several arrays of so many bytes, each where a cache line begins; NULL
// when memory is short.
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

// Arrays that are too short are made anew, all of them: what was in them has been fetched.
static enum dig_status make_grains_room(struct dig_offloaded *const o, const size_t n)
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
    free(o->grain_arrays);
    o->grain_arrays    = allocate(5, bytes, array);
    o->grains_room     = o->grain_arrays != NULL ? n + 1 : 0;
    v->load_start      = array[0];
    v->surface_history = array[1];
    v->surface_mask    = array[2];
    v->surface_load    = array[3];
    v->on_tool         = array[4];
    return o->grain_arrays != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_pairs_room(struct dig_offloaded *const o, const size_t pairs)
{
    struct dig_device_view *const v       = &o->view;
    const size_t                  room    = pairs + pairs / 8 + 1;
    const size_t                  bytes[] = {
                         room * sizeof *v->pair_i,        room * sizeof *v->load_index,
                         room * sizeof *v->pair_history,  2 * room * sizeof *v->touching,
                         2 * room * sizeof *v->pair_load,
    };
    void *array[5] = { NULL };
    free(o->pair_arrays);
    o->pair_arrays  = allocate(5, bytes, array);
    o->pairs_room   = o->pair_arrays != NULL ? room : 0;
    v->pair_i       = array[0];
    v->load_index   = array[1];
    v->pair_history = array[2];
    v->touching     = array[3];
    v->pair_load    = array[4];
    return o->pair_arrays != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_room(struct dig_offloaded *const o, const size_t n, const size_t pairs)
{
    enum dig_status status = o->grains_room < n + 1 ? make_grains_room(o, n) : DIG_OK;
    if (status == DIG_OK && o->pairs_room < pairs + 1) {
        status = make_pairs_room(o, pairs);
    }
    return status;
}

static struct dig_contact_history load_history(const struct dig_contacts *const list,
                                               const size_t c, const double sign)
{
    double *const *const m = list->history;
    return (struct dig_contact_history){ sign * m[0][c], sign * m[1][c], sign * m[2][c],
                                         sign * m[3][c], sign * m[4][c], sign * m[5][c] };
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

// The sum over grains goes to the world; the grains begin anew.
static void sum_wrenches(struct dig_world *const w)
{
    struct dig_device_view *const v = &w->offloaded->view;
    for (uint32_t i = 0; i < v->n; i++) {
        for (int k = 0; k < 3; k++) {
            w->sum_tool.f_N[k] += v->on_tool[i].f_N[k];
            w->sum_tool.t_Nm[k] += v->on_tool[i].t_Nm[k];
        }
    }
    memset(v->on_tool, 0, v->n * sizeof *v->on_tool);
}

enum dig_status dig_offloaded_sync_motion(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (o->is_synced || o->is_motion_synced) {
        return DIG_OK;
    }
    const enum dig_status status = o->device->download(o->device, false);
    if (status == DIG_OK) {
        sum_wrenches(w);
        o->is_motion_synced = true;
    }
    return status;
}

static enum dig_status read_pairs(struct dig_world *const w)
{
    const struct dig_device_view *const v      = &w->offloaded->view;
    enum dig_status                     status = DIG_OK;
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

static enum dig_status read_surfaces(struct dig_world *const w)
{
    const struct dig_device_view *const v      = &w->offloaded->view;
    enum dig_status                     status = DIG_OK;
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

enum dig_status dig_offloaded_sync(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (o->is_synced) {
        return DIG_OK;
    }
    enum dig_status status = o->device->download(o->device, true);
    if (status != DIG_OK) {
        return status;
    }
    sum_wrenches(w);
    clear_lists(w);
    status       = read_pairs(w);
    status       = status == DIG_OK ? read_surfaces(w) : status;
    o->is_synced = status == DIG_OK;
    return status;
}

// The pushes on a grain stand in a row, in the order of the places of its pairs: so their sum is
// the same wherever it is made.
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
    // Filling moves every beginning to its end, which is the next one's beginning.
    for (uint32_t p = 0; p < v->pairs; p++) {
        v->load_index[p][0] = first[row[p]]++;
        v->load_index[p][1] = first[near->other[p]]++;
    }
    memmove(first + 1, first, v->n * sizeof *first);
    first[0] = 0;
}

static void write_pairs(const struct dig_world *const w)
{
    struct dig_device_view *const v = &w->offloaded->view;
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

// One list of surface contacts, those of surface j of the list at number first + j.
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

static void write_surfaces(const struct dig_world *const w)
{
    const struct dig_device_view *const v = &w->offloaded->view;
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

// Laws for both orders of two kinds.
static void write_laws(const struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    for (size_t a = 0; a < w->grains.types; a++) {
        for (size_t b = a; b < w->grains.types; b++) {
            const struct dig_law law            = w->pair_law[a * DIG_GRAIN_TYPES_MAX + b];
            struct dig_law       turned         = law;
            turned.lever_i_m                    = law.lever_j_m;
            turned.lever_j_m                    = law.lever_i_m;
            o->law[a * DIG_GRAIN_TYPES_MAX + b] = law;
            o->law[b * DIG_GRAIN_TYPES_MAX + a] = turned;
        }
    }
}

// New lists from what is here, and all of it to the device.
static enum dig_status upload(struct dig_world *const w)
{
    struct dig_offloaded *const o      = w->offloaded;
    enum dig_status             status = dig_lists_rebuild(w, wide_skin);
    const size_t                n      = w->grains.n;
    const size_t                pairs  = status == DIG_OK ? w->neighbours.start[n] : 0;
    status                             = status == DIG_OK ? make_room(o, n, pairs) : status;
    if (status != DIG_OK) {
        return status;
    }
    struct dig_device_view *const v = &o->view;
    v->n                            = (uint32_t)n;
    v->pairs                        = (uint32_t)pairs;
    v->type_of                      = w->grains.type_of;
    v->reference_m                  = (const double(*)[4])w->neighbours.reference_m;
    v->pair_j                       = w->neighbours.other;
    v->pair_law                     = o->law;
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
    write_laws(w);
    write_pairs(w);
    write_surfaces(w);
    memset(v->on_tool, 0, n * sizeof *v->on_tool);
    memset(v->margin_flag, 0, DIG_MARGIN_FLAGS * sizeof *v->margin_flag);
    o->unpolled_steps = 0;
    return o->device->upload(o->device, v);
}

static size_t poll_interval(const struct dig_world *const w)
{
    return w->bodies != NULL && w->bodies->obstacles.rocks > 0 ? ROCKS_POLL_STEPS : POLL_STEPS;
}

static struct dig_device_step make_step(const struct dig_world *const w)
{
    struct dig_device_step step = {
        .kick_s         = w->started ? w->dt_s : 0.5 * w->dt_s,
        .dt_s           = w->dt_s,
        .horizon_s      = SPEED_RESERVE * (double)poll_interval(w) * w->dt_s,
        .gravity_mps2   = { w->gravity_mps2[0], w->gravity_mps2[1], w->gravity_mps2[2] },
        .period_y_m     = w->period_y_m,
        .inverse_period = dig_period_inverse(w->period_y_m),
        .walls          = (uint32_t)w->walls,
        .has_tool       = w->tool != NULL,
    };
    memcpy(step.wall, w->wall, sizeof step.wall);
    if (w->tool != NULL) {
        step.tool = *w->tool;
    }
    step.rocks = w->bodies == NULL ? 0 : (uint32_t)w->bodies->obstacles.rocks;
    for (uint32_t r = 0; r < step.rocks; r++) {
        step.rock[r] = dig_rock_surface_of(&w->bodies->obstacles.rock[r]);
    }
    return step;
}

// Whether lists have to be made anew, asked for every so many steps.
static enum dig_status poll_margins(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (++o->unpolled_steps < poll_interval(w)) {
        return DIG_OK;
    }
    uint32_t margin_flag[DIG_MARGIN_FLAGS] = { 0 };
    o->unpolled_steps                      = 0;
    const enum dig_status status           = o->device->poll_margins(o->device, margin_flag);
    if (status == DIG_OK && margin_flag[DIG_MARGIN_LEFT] != 0) {
        return DIG_EINVAL;
    }
    w->stale = w->stale || margin_flag[DIG_MARGIN_NEARLY_LEFT] != 0;
    return status;
}

enum dig_status dig_offloaded_step(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (w->stale) {
        enum dig_status status = dig_offloaded_sync(w);
        if (status == DIG_OK && !dig_grains_are_sound(&w->grains, w->dt_s)) {
            status = DIG_EINVAL;
        }
        status = status == DIG_OK ? upload(w) : status;
        if (status != DIG_OK) {
            return status;
        }
        w->stale = false;
    }
    const struct dig_device_step step   = make_step(w);
    enum dig_status              status = o->device->step(o->device, &step);
    o->is_synced                        = false;
    o->is_motion_synced                 = false;
    status                              = status == DIG_OK ? poll_margins(w) : status;
    w->started                          = true;
    w->steps++;
    return status;
}
