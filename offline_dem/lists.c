#include "offline_dem/lists.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The margins trade rebuilds against idle contacts; measured on a bed of 7000 grains being dug.
#define SKIN_RADII    0.16 // neighbour list: what a slow grain may move, in its radii
#define SKIN_STEPS    100  // … and a fast one, in steps of its speed
#define CONTACT_RADII 0.008
#define CONTACT_STEPS 10
#define NOTHING       UINT32_MAX

static double speed(const struct dig_motion *const m)
{
    return sqrt(m->v_mps[0] * m->v_mps[0] + m->v_mps[1] * m->v_mps[1] + m->v_mps[2] * m->v_mps[2]);
}

static double contact_margin(const struct dig_world *const w, const size_t i)
{
    const struct dig_grains *const g = &w->grains;
    return CONTACT_RADII * g->kind[g->of[i]].radius_m +
           CONTACT_STEPS * w->dt_s * speed(&g->motion[i]);
}

void dig_lists_move(struct dig_world *const w, const uint32_t place[])
{
    for (size_t l = 0; l < (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX + DIG_KINDS_MAX; l++) {
        const bool                 pairs = l < (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX;
        struct dig_contacts *const list =
            pairs ? &w->pair[l] : &w->surface[l - (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX];
        size_t kept = 0;
        for (size_t c = 0; c < list->n; c++) {
            const uint32_t i = place[list->i[c]];
            const uint32_t j = pairs ? place[list->j[c]] : list->j[c];
            if (i == NOTHING || j == NOTHING) {
                continue;
            }
            list->i[kept]   = i;
            list->j[kept]   = j;
            list->key[kept] = NOTHING;
            for (int m = 0; m < DIG_MEMORIES; m++) {
                list->memory[m][kept] = list->memory[m][c];
            }
            kept++;
        }
        list->n = kept;
    }
}

static uint32_t find_slot(const struct dig_neighbours *const near, const uint32_t i,
                          const uint32_t j)
{
    for (uint32_t s = near->start[i]; s < near->start[i + 1]; s++) {
        if (near->other[s] == j) {
            return s;
        }
    }
    return NOTHING;
}

// Where each contact stands in a new neighbour list. A pair listed the other way round turns over.
static void find_slots(struct dig_world *const w)
{
    for (size_t l = 0; l < (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX; l++) {
        struct dig_contacts *const list = &w->pair[l];
        const bool                 like = l / DIG_KINDS_MAX == l % DIG_KINDS_MAX;
        for (size_t c = 0; c < list->n; c++) {
            const uint32_t i    = list->i[c];
            const uint32_t j    = list->j[c];
            uint32_t       slot = find_slot(&w->near_list, i, j);
            if (slot == NOTHING) {
                slot = find_slot(&w->near_list, j, i);
                if (like && slot != NOTHING) {
                    list->i[c] = j;
                    list->j[c] = i;
                    for (int m = 0; m < DIG_MEMORIES; m++) {
                        list->memory[m][c] = -list->memory[m][c];
                    }
                }
            }
            list->key[c] = slot;
        }
    }
}

// Sorts the grains along cells and remakes the neighbour list.
static enum dig_status relist(struct dig_world *const w)
{
    const size_t    n      = w->grains.n;
    uint32_t *const order  = malloc((n + 1) * sizeof *order);
    uint32_t *const place  = calloc(n + 1, sizeof *place);
    double *const   margin = malloc((n + 1) * sizeof *margin);
    enum dig_status status = DIG_ENOMEM;
    if (order == NULL || place == NULL || margin == NULL) {
        goto done;
    }
    double radius_max_m = 0.0;
    for (size_t k = 0; k < w->grains.kinds; k++) {
        radius_max_m = fmax(radius_max_m, w->grains.kind[k].radius_m);
    }
    status = dig_neighbours_order(&w->grains, 2.0 * radius_max_m, order);
    if (status != DIG_OK) {
        goto done;
    }
    for (size_t k = 0; k < n; k++) {
        place[order[k]] = (uint32_t)k;
    }
    status = dig_grains_reorder(&w->grains, order);
    if (status != DIG_OK) {
        goto done;
    }
    dig_lists_move(w, place);
    for (size_t i = 0; i < n; i++) {
        margin[i] = SKIN_RADII * w->grains.kind[w->grains.of[i]].radius_m +
                    SKIN_STEPS * w->dt_s * speed(&w->grains.motion[i]);
    }
    status = dig_neighbours_build(&w->grains, margin, &w->near_list);
    if (status != DIG_OK) {
        goto done;
    }
    find_slots(w);
    w->list_rebuilds++;

done:
    free(order);
    free(place);
    free(margin);
    return status;
}

// Whether contacts may be picked from the neighbour list: what each grain has moved since, and the
// margin it is to have now, fit into the margin it had then.
static bool is_covered(const struct dig_world *const w)
{
    if (w->near_list.n != w->grains.n || w->near_list.start == NULL) {
        return false;
    }
    for (size_t i = 0; i < w->grains.n; i++) {
        const double *const x    = w->grains.motion[i].x_m;
        const double *const was  = w->near_list.at_m[i];
        const double        d[3] = { x[0] - was[0], x[1] - was[1], x[2] - was[2] };
        const double        left = was[3] - w->at_m[i][3];
        if (!(left > 0.0 && d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < left * left)) {
            return false;
        }
    }
    return true;
}

static enum dig_status pick_pairs(struct dig_world *const w)
{
    const struct dig_grains *const     g     = &w->grains;
    const struct dig_neighbours *const near  = &w->near_list;
    const size_t                       slots = near->start[g->n];
    uint32_t *const                    was   = malloc(2 * (slots + 1) * sizeof *was);
    if (was == NULL) {
        return DIG_ENOMEM;
    }
    uint32_t *const close = was + slots + 1;
    memset(was, 0xff, slots * sizeof *was);
    const size_t        lists = (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX;
    struct dig_contacts fresh[DIG_KINDS_MAX * DIG_KINDS_MAX] = { 0 };
    enum dig_status     status                               = DIG_OK;
    for (size_t l = 0; l < lists; l++) {
        for (size_t c = 0; c < w->pair[l].n; c++) {
            if (w->pair[l].key[c] != NOTHING) {
                was[w->pair[l].key[c]] = (uint32_t)c;
            }
        }
    }
    for (uint32_t i = 0; i < g->n && status == DIG_OK; i++) {
        // Which pairs of this grain are close: written whether they are or not, because a branch
        // would be guessed wrong every third time.
        const double *const x     = g->motion[i].x_m;
        const double        own_m = g->kind[g->of[i]].radius_m + w->at_m[i][3];
        size_t              count = 0;
        for (uint32_t s = near->start[i]; s < near->start[i + 1]; s++) {
            const uint32_t      j       = near->other[s];
            const double *const y       = g->motion[j].x_m;
            const double        d[3]    = { x[0] - y[0], x[1] - y[1], x[2] - y[2] };
            const double        reach_m = own_m + g->kind[g->of[j]].radius_m + w->at_m[j][3];
            close[count]                = s;
            count += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m;
        }
        for (size_t c = 0; c < count && status == DIG_OK; c++) {
            const uint32_t s    = close[c];
            const uint32_t j    = near->other[s];
            const bool     turn = g->of[i] > g->of[j];
            const uint32_t a    = turn ? j : i;
            const uint32_t b    = turn ? i : j;
            const size_t   l    = (size_t)g->of[a] * DIG_KINDS_MAX + g->of[b];
            status = dig_contacts_add(&fresh[l], a, b, s, was[s] == NOTHING ? NULL : &w->pair[l],
                                      was[s]);
        }
    }
    free(was);
    for (size_t l = 0; l < lists; l++) {
        if (status == DIG_OK) {
            const struct dig_contacts old = w->pair[l];
            w->pair[l]                    = fresh[l];
            fresh[l]                      = old;
        }
        dig_contacts_finish(&fresh[l]);
    }
    return status;
}

static enum dig_status pick_plates(const struct dig_world *const w, const uint32_t i,
                                   const double reach_m, const uint32_t was[],
                                   struct dig_contacts *const fresh)
{
    const struct dig_tool *const tool = w->tool;
    const double *const          x    = w->grains.motion[i].x_m;
    const double                 dx = x[0] - tool->pose.x_m, dz = x[2] - tool->pose.z_m;
    const double                 far_m = tool->radius_m + reach_m;
    if (dx * dx + dz * dz > far_m * far_m || fabs(x[1]) > 0.5 * tool->bucket.width_m + reach_m) {
        return DIG_OK;
    }
    enum dig_status status = DIG_OK;
    double          body_m[3];
    dig_tool_to_body(tool, x, body_m);
    const size_t kind = w->grains.of[i];
    for (size_t p = 0; p < tool->plates && status == DIG_OK; p++) {
        double c[3];
        dig_tool_closest(tool, p, body_m, c);
        const double d[3] = { body_m[0] - c[0], body_m[1] - c[1], body_m[2] - c[2] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m) {
            const size_t surface = w->walls + p;
            status =
                dig_contacts_add(&fresh[kind], i, (uint32_t)surface, (uint32_t)surface,
                                 was[surface] == NOTHING ? NULL : &w->surface[kind], was[surface]);
        }
    }
    return status;
}

static enum dig_status pick_surfaces(struct dig_world *const w)
{
    const struct dig_grains *const g        = &w->grains;
    const size_t                   surfaces = w->walls + (w->tool != NULL ? w->tool->plates : 0);
    uint32_t *const                was      = malloc((g->n * surfaces + 1) * sizeof *was);
    if (was == NULL) {
        return DIG_ENOMEM;
    }
    memset(was, 0xff, g->n * surfaces * sizeof *was);
    struct dig_contacts fresh[DIG_KINDS_MAX] = { 0 };
    enum dig_status     status               = DIG_OK;
    for (size_t k = 0; k < DIG_KINDS_MAX; k++) {
        for (size_t c = 0; c < w->surface[k].n; c++) {
            if (w->surface[k].j[c] >= surfaces) {
                continue; // the tool has been taken away
            }
            was[w->surface[k].i[c] * surfaces + w->surface[k].j[c]] = (uint32_t)c;
        }
    }
    for (uint32_t i = 0; i < g->n && status == DIG_OK; i++) {
        const double *const   x       = g->motion[i].x_m;
        const size_t          kind    = g->of[i];
        const double          reach_m = g->kind[kind].radius_m + w->at_m[i][3];
        const uint32_t *const known   = was + i * surfaces;
        for (uint32_t s = 0; s < w->walls && status == DIG_OK; s++) {
            const double *const normal = w->wall[s].normal;
            const double        height_m =
                normal[0] * x[0] + normal[1] * x[1] + normal[2] * x[2] - w->wall[s].offset_m;
            if (height_m < reach_m) {
                status = dig_contacts_add(&fresh[kind], i, s, s,
                                          known[s] == NOTHING ? NULL : &w->surface[kind], known[s]);
            }
        }
        if (w->tool != NULL && status == DIG_OK) {
            status = pick_plates(w, i, reach_m + w->tool_margin_m, known, fresh);
        }
    }
    free(was);
    for (size_t k = 0; k < DIG_KINDS_MAX; k++) {
        if (status == DIG_OK) {
            const struct dig_contacts old = w->surface[k];
            w->surface[k]                 = fresh[k];
            fresh[k]                      = old;
        }
        dig_contacts_finish(&fresh[k]);
    }
    return status;
}

static void set_margins(struct dig_world *const w)
{
    for (size_t i = 0; i < w->grains.n; i++) {
        memcpy(w->at_m[i], w->grains.motion[i].x_m, 3 * sizeof(double));
        w->at_m[i][3] = contact_margin(w, i);
    }
    if (w->tool != NULL) {
        const double speed_mps =
            hypot(w->tool->vx_mps, w->tool->vz_mps) + w->tool->radius_m * fabs(w->tool->w_radps);
        w->tool_at = w->tool->pose;
        w->tool_margin_m =
            CONTACT_RADII * w->grains.kind[0].radius_m + 2.0 * CONTACT_STEPS * w->dt_s * speed_mps;
    }
}

enum dig_status dig_lists_update(struct dig_world *const w)
{
    const size_t n = w->grains.n;
    if (w->at_room < n + 1) {
        double(*const at)[4] = realloc(w->at_m, (n + 1) * sizeof *at);
        if (at == NULL) {
            return DIG_ENOMEM;
        }
        w->at_m    = at;
        w->at_room = n + 1;
    }
    set_margins(w);
    if (!is_covered(w)) {
        const enum dig_status status = relist(w);
        if (status != DIG_OK) {
            return status;
        }
        set_margins(w);
    }
    enum dig_status status = pick_pairs(w);
    if (status == DIG_OK) {
        status = pick_surfaces(w);
    }
    if (status == DIG_OK) {
        w->stale = false;
        w->contact_rebuilds++;
    }
    return status;
}

void dig_lists_finish(struct dig_world *const w)
{
    for (size_t l = 0; l < (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX; l++) {
        dig_contacts_finish(&w->pair[l]);
    }
    for (size_t k = 0; k < DIG_KINDS_MAX; k++) {
        dig_contacts_finish(&w->surface[k]);
    }
    dig_neighbours_finish(&w->near_list);
    free(w->at_m);
    w->at_m    = NULL;
    w->at_room = 0;
}
