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
#define LINE         ((size_t)64) // bytes of a cache line
#define ATTEND_STEPS 16           // between two looks at what the grains call for, and
#define ROCKS_STEPS  2            // where a grain may be squeezed out between bucket and rock
#define AHEAD        2.0          // what a grain may speed up by meanwhile

struct dig_offloaded {
    struct dig_device     *device;
    struct dig_device_view view;
    struct dig_law         law[DIG_DEVICE_LAWS];
    void                  *of_grains, *of_pairs; // the view's arrays of grains, and of pairs
    size_t                 grains_room, pairs_room;
    bool                   is_here; // all of the state, contacts in the world's lists
    bool                   is_seen; // motions are those of the last step
    size_t                 unattended;
};

enum dig_status dig_offload(struct dig_world *const w, struct dig_device *const device)
{
    assert(w != NULL && device != NULL && w->offloaded == NULL);
    assert(w->bodies == NULL || w->bodies->ode == NULL);
    struct dig_offloaded *const o = calloc(1, sizeof *o);
    if (o == NULL) {
        return DIG_ENOMEM;
    }
    o->device         = device;
    o->is_here        = true;
    o->is_seen        = true;
    o->view.attention = calloc(DIG_ATTENTIONS, sizeof *o->view.attention);
    if (o->view.attention == NULL) {
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
        free(o->of_grains);
        free(o->of_pairs);
        free(o->view.attention);
        free(o);
    }
}

// One block of memory for several arrays of so many bytes, each where a cache line begins; NULL
// when memory is short.
static void *allocate(const size_t arrays, const size_t bytes[], void *array[])
{
    size_t sum = 0;
    for (size_t a = 0; a < arrays; a++) {
        sum += (bytes[a] + LINE - 1) / LINE * LINE;
    }
    unsigned char *const block = aligned_alloc(LINE, sum);
    unsigned char       *next  = block;
    for (size_t a = 0; a < arrays && block != NULL; a++) {
        array[a] = next;
        next += (bytes[a] + LINE - 1) / LINE * LINE;
    }
    return block;
}

// Arrays that are too short are made anew, all of them: what was in them has been fetched.
static enum dig_status make_grains_room(struct dig_offloaded *const o, const size_t n)
{
    struct dig_device_view *const v       = &o->view;
    const size_t                  bytes[] = {
                         (n + 1) * sizeof *v->first,    DIG_DEVICE_SURFACES * (n + 1) * sizeof *v->surface,
                         (n + 1) * sizeof *v->surfaces, (n + 1) * sizeof *v->outside,
                         (n + 1) * sizeof *v->on_tool,
    };
    void *array[5] = { NULL };
    free(o->of_grains);
    o->of_grains   = allocate(5, bytes, array);
    o->grains_room = o->of_grains != NULL ? n + 1 : 0;
    v->first       = array[0];
    v->surface     = array[1];
    v->surfaces    = array[2];
    v->outside     = array[3];
    v->on_tool     = array[4];
    return o->of_grains != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_pairs_room(struct dig_offloaded *const o, const size_t pairs)
{
    struct dig_device_view *const v       = &o->view;
    const size_t                  room    = pairs + pairs / 8 + 1;
    const size_t                  bytes[] = {
                         room * sizeof *v->row,          room * sizeof *v->push_of,  room * sizeof *v->memory,
                         2 * room * sizeof *v->touching, 2 * room * sizeof *v->push,
    };
    void *array[5] = { NULL };
    free(o->of_pairs);
    o->of_pairs   = allocate(5, bytes, array);
    o->pairs_room = o->of_pairs != NULL ? room : 0;
    v->row        = array[0];
    v->push_of    = array[1];
    v->memory     = array[2];
    v->touching   = array[3];
    v->push       = array[4];
    return o->of_pairs != NULL ? DIG_OK : DIG_ENOMEM;
}

static enum dig_status make_room(struct dig_offloaded *const o, const size_t n, const size_t pairs)
{
    enum dig_status status = o->grains_room < n + 1 ? make_grains_room(o, n) : DIG_OK;
    if (status == DIG_OK && o->pairs_room < pairs + 1) {
        status = make_pairs_room(o, pairs);
    }
    return status;
}

static struct dig_memory recall(const struct dig_contacts *const list, const size_t c,
                                const double sign)
{
    double *const *const m = list->memory;
    return (struct dig_memory){ sign * m[0][c], sign * m[1][c], sign * m[2][c],
                                sign * m[3][c], sign * m[4][c], sign * m[5][c] };
}

static enum dig_status remember(struct dig_contacts *const list, const uint32_t i, const uint32_t j,
                                const struct dig_memory *const memory, const double sign)
{
    const enum dig_status status = dig_contacts_add(list, i, j, UINT32_MAX, NULL, 0);
    if (status == DIG_OK) {
        const double m[DIG_MEMORIES] = { memory->sx_m,  memory->sy_m,  memory->sz_m,
                                         memory->mx_Nm, memory->my_Nm, memory->mz_Nm };
        for (int k = 0; k < DIG_MEMORIES; k++) {
            list->memory[k][list->n - 1] = sign * m[k];
        }
    }
    return status;
}

// The sum over grains goes to the world; the grains begin anew.
static void take_wrenches(struct dig_world *const w)
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

enum dig_status dig_offloaded_look(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (o->is_here || o->is_seen) {
        return DIG_OK;
    }
    const enum dig_status status = o->device->download(o->device, false);
    if (status == DIG_OK) {
        take_wrenches(w);
        o->is_seen = true;
    }
    return status;
}

static enum dig_status fetch_pairs(struct dig_world *const w)
{
    const struct dig_device_view *const v      = &w->offloaded->view;
    enum dig_status                     status = DIG_OK;
    for (uint32_t p = 0; p < v->pairs && status == DIG_OK; p++) {
        if (v->touching[v->push_of[p][0]] == 0) {
            continue;
        }
        const uint32_t i = v->row[p];
        const uint32_t j = v->other[p];
        const size_t   a = v->of[i];
        const size_t   b = v->of[j];
        status           = a <= b
                               ? remember(&w->pair[a * DIG_GRAIN_TYPES_MAX + b], i, j, &v->memory[p], 1.0)
                               : remember(&w->pair[b * DIG_GRAIN_TYPES_MAX + a], j, i, &v->memory[p], -1.0);
    }
    return status;
}

static enum dig_status fetch_surfaces(struct dig_world *const w)
{
    const struct dig_device_view *const v      = &w->offloaded->view;
    enum dig_status                     status = DIG_OK;
    for (uint32_t i = 0; i < v->n; i++) {
        for (uint32_t s = 0; s < v->surfaces_used && v->surfaces[i] >> s != 0 && status == DIG_OK;
             s++) {
            if ((v->surfaces[i] >> s & 1) == 0) {
                continue;
            }
            const struct dig_memory *const memory = &v->surface[(size_t)s * v->n + i];
            const size_t                   kind   = v->of[i];
            if (s < DIG_WALLS_MAX) {
                status = remember(&w->surface[kind], i, s, memory, 1.0);
            } else if (s < DIG_DEVICE_ROCKS) {
                status = remember(&w->surface[DIG_GRAIN_TYPES_MAX + kind], i,
                                  (uint32_t)w->walls + s - DIG_WALLS_MAX, memory, 1.0);
            } else {
                status = remember(&w->bodies->obstacles.contact[kind], i, s - DIG_DEVICE_ROCKS,
                                  memory, 1.0);
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

enum dig_status dig_offloaded_fetch(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (o->is_here) {
        return DIG_OK;
    }
    enum dig_status status = o->device->download(o->device, true);
    if (status != DIG_OK) {
        return status;
    }
    take_wrenches(w);
    clear_lists(w);
    status     = fetch_pairs(w);
    status     = status == DIG_OK ? fetch_surfaces(w) : status;
    o->is_here = status == DIG_OK;
    return status;
}

// The pushes on a grain stand in a row, in the order of the places of its pairs: so their sum is
// the same wherever it is made.
static void place_pushes(const struct dig_neighbours *const near, struct dig_device_view *const v)
{
    uint32_t *const first = v->first;
    uint32_t *const row   = v->row;
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
        v->push_of[p][0] = first[row[p]]++;
        v->push_of[p][1] = first[near->other[p]]++;
    }
    memmove(first + 1, first, v->n * sizeof *first);
    first[0] = 0;
}

static void send_pairs(const struct dig_world *const w)
{
    struct dig_device_view *const v = &w->offloaded->view;
    memset(v->memory, 0, v->pairs * sizeof *v->memory);
    memset(v->touching, 0, 2 * (size_t)v->pairs * sizeof *v->touching);
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        const struct dig_contacts *const list = &w->pair[l];
        for (size_t c = 0; c < list->n; c++) {
            const uint32_t p = list->key[c];
            if (p != UINT32_MAX) {
                v->memory[p] = recall(list, c, v->row[p] == list->i[c] ? 1.0 : -1.0);
                v->touching[v->push_of[p][0]] = 1;
                v->touching[v->push_of[p][1]] = 1;
            }
        }
    }
}

// One list of surface contacts, those of surface j of the list at number first + j.
static void send_list(const struct dig_contacts *const list, const uint32_t first,
                      const struct dig_device_view *const v)
{
    for (size_t c = 0; c < list->n; c++) {
        const uint32_t i                 = list->i[c];
        const uint32_t s                 = first + list->j[c];
        v->surface[(size_t)s * v->n + i] = recall(list, c, 1.0);
        v->surfaces[i] |= (uint64_t)1 << s;
    }
}

static void send_surfaces(const struct dig_world *const w)
{
    const struct dig_device_view *const v = &w->offloaded->view;
    memset(v->surface, 0, v->surfaces_used * (size_t)v->n * sizeof *v->surface);
    memset(v->surfaces, 0, v->n * sizeof *v->surfaces);
    for (size_t k = 0; k < DIG_GRAIN_TYPES_MAX; k++) {
        send_list(&w->surface[k], 0, v);
        send_list(&w->surface[DIG_GRAIN_TYPES_MAX + k], DIG_WALLS_MAX - (uint32_t)w->walls, v);
        if (w->bodies != NULL) {
            send_list(&w->bodies->obstacles.contact[k], DIG_DEVICE_ROCKS, v);
        }
    }
}

// Laws for both orders of two kinds.
static void send_laws(const struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    for (size_t a = 0; a < w->grains.kinds; a++) {
        for (size_t b = a; b < w->grains.kinds; b++) {
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
static enum dig_status send(struct dig_world *const w)
{
    struct dig_offloaded *const o      = w->offloaded;
    enum dig_status             status = dig_lists_renew(w, wide_skin);
    const size_t                n      = w->grains.n;
    const size_t                pairs  = status == DIG_OK ? w->near_list.start[n] : 0;
    status                             = status == DIG_OK ? make_room(o, n, pairs) : status;
    if (status != DIG_OK) {
        return status;
    }
    struct dig_device_view *const v = &o->view;
    v->n                            = (uint32_t)n;
    v->pairs                        = (uint32_t)pairs;
    v->of                           = w->grains.of;
    v->at_m                         = (const double(*)[4])w->near_list.at_m;
    v->other                        = w->near_list.other;
    v->pair_law                     = o->law;
    v->wall_law                     = w->wall_law;
    v->tool_law                     = w->tool_law;
    v->kind                         = w->grains.kind;
    v->motion                       = w->grains.motion;
    v->surfaces_used                = DIG_DEVICE_ROCKS;
    if (w->bodies != NULL) {
        v->clumps = (uint32_t)w->bodies->clumps;
        v->clump  = w->bodies->clump;
        v->shape  = &w->bodies->shape;
        v->surfaces_used += (uint32_t)w->bodies->obstacles.rocks;
    }
    place_pushes(&w->near_list, v);
    send_laws(w);
    send_pairs(w);
    send_surfaces(w);
    memset(v->on_tool, 0, n * sizeof *v->on_tool);
    memset(v->attention, 0, DIG_ATTENTIONS * sizeof *v->attention);
    o->unattended = 0;
    return o->device->upload(o->device, v);
}

static size_t attend_steps(const struct dig_world *const w)
{
    return w->bodies != NULL && w->bodies->obstacles.rocks > 0 ? ROCKS_STEPS : ATTEND_STEPS;
}

static struct dig_device_step step_of(const struct dig_world *const w)
{
    struct dig_device_step step = {
        .kick_s       = w->started ? w->dt_s : 0.5 * w->dt_s,
        .dt_s         = w->dt_s,
        .ahead_s      = AHEAD * (double)attend_steps(w) * w->dt_s,
        .gravity_mps2 = { w->gravity_mps2[0], w->gravity_mps2[1], w->gravity_mps2[2] },
        .period_y_m   = w->period_y_m,
        .per_m        = dig_period_inverse(w->period_y_m),
        .walls        = (uint32_t)w->walls,
        .digs         = w->tool != NULL,
    };
    memcpy(step.wall, w->wall, sizeof step.wall);
    if (w->tool != NULL) {
        step.tool = *w->tool;
    }
    step.rocks = w->bodies == NULL ? 0 : (uint32_t)w->bodies->obstacles.rocks;
    for (uint32_t r = 0; r < step.rocks; r++) {
        step.rock[r] = dig_rock_place(&w->bodies->obstacles.rock[r]);
    }
    return step;
}

// Whether lists have to be made anew, asked for every so many steps.
static enum dig_status attend(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (++o->unattended < attend_steps(w)) {
        return DIG_OK;
    }
    uint32_t attention[DIG_ATTENTIONS] = { 0 };
    o->unattended                      = 0;
    const enum dig_status status       = o->device->attend(o->device, attention);
    if (status == DIG_OK && attention[DIG_ATTENTION_LEFT] != 0) {
        return DIG_EINVAL;
    }
    w->stale = w->stale || attention[DIG_ATTENTION_SOON] != 0;
    return status;
}

enum dig_status dig_offloaded_step(struct dig_world *const w)
{
    struct dig_offloaded *const o = w->offloaded;
    if (w->stale) {
        enum dig_status status = dig_offloaded_fetch(w);
        if (status == DIG_OK && !dig_grains_are_sound(&w->grains, w->dt_s)) {
            status = DIG_EINVAL;
        }
        status = status == DIG_OK ? send(w) : status;
        if (status != DIG_OK) {
            return status;
        }
        w->stale = false;
    }
    const struct dig_device_step step   = step_of(w);
    enum dig_status              status = o->device->step(o->device, &step);
    o->is_here                          = false;
    o->is_seen                          = false;
    status                              = status == DIG_OK ? attend(w) : status;
    w->started                          = true;
    w->steps++;
    return status;
}
