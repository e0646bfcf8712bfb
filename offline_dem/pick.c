#include "offline_dem/pick.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Puts the fresh lists in the place of the old, or gives them up.
static void adopt(const enum dig_status status, const size_t lists, struct dig_contacts old[],
                  struct dig_contacts fresh[])
{
    for (size_t l = 0; l < lists; l++) {
        if (status == DIG_OK) {
            const struct dig_contacts before = old[l];
            old[l]                           = fresh[l];
            fresh[l]                         = before;
        }
        dig_contacts_finish(&fresh[l]);
    }
}

static void index_pairs(const struct dig_world *const w, uint32_t was[])
{
    for (size_t l = 0; l < (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX; l++) {
        for (size_t c = 0; c < w->pair[l].n; c++) {
            if (w->pair[l].key[c] != DIG_NO_SLOT) {
                was[w->pair[l].key[c]] = (uint32_t)c;
            }
        }
    }
}

// The pairs of grain i that are close: written whether they are or not, because a branch would be
// guessed wrong every third time.
static size_t find_close(const struct dig_world *const w, const uint32_t i, uint32_t close[])
{
    const struct dig_grains *const     g     = &w->grains;
    const struct dig_neighbours *const near  = &w->near_list;
    const double *const                x     = g->motion[i].x_m;
    const double                       own_m = g->kind[g->of[i]].radius_m + w->at_m[i][3];
    size_t                             count = 0;
    for (uint32_t s = near->start[i]; s < near->start[i + 1]; s++) {
        const uint32_t      j       = near->other[s];
        const double *const y       = g->motion[j].x_m;
        const double        d[3]    = { x[0] - y[0], x[1] - y[1], x[2] - y[2] };
        const double        reach_m = own_m + g->kind[g->of[j]].radius_m + w->at_m[j][3];
        close[count]                = s;
        count += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m;
    }
    return count;
}

enum dig_status dig_pick_pairs(struct dig_world *const w)
{
    const struct dig_grains *const g     = &w->grains;
    const size_t                   slots = w->near_list.start[g->n];
    uint32_t *const                was   = malloc(2 * (slots + 1) * sizeof *was);
    if (was == NULL) {
        return DIG_ENOMEM;
    }
    uint32_t *const close = was + slots + 1;
    memset(was, 0xff, slots * sizeof *was);
    index_pairs(w, was);

    struct dig_contacts fresh[DIG_KINDS_MAX * DIG_KINDS_MAX] = { 0 };
    enum dig_status     status                               = DIG_OK;
    for (uint32_t i = 0; i < g->n && status == DIG_OK; i++) {
        const size_t count = find_close(w, i, close);
        for (size_t c = 0; c < count && status == DIG_OK; c++) {
            // Grains of unlike kinds stand in the order of their kinds.
            const uint32_t s    = close[c];
            const uint32_t j    = w->near_list.other[s];
            const bool     turn = g->of[i] > g->of[j];
            const uint32_t a    = turn ? j : i;
            const uint32_t b    = turn ? i : j;
            const size_t   l    = (size_t)g->of[a] * DIG_KINDS_MAX + g->of[b];
            status              = dig_contacts_add(&fresh[l], a, b, s,
                                      was[s] == DIG_NO_SLOT ? NULL : &w->pair[l], was[s]);
        }
    }
    free(was);
    adopt(status, (size_t)DIG_KINDS_MAX * DIG_KINDS_MAX, w->pair, fresh);
    return status;
}

static enum dig_status add_surface(const struct dig_world *const w, const uint32_t i,
                                   const size_t surface, const uint32_t known[],
                                   struct dig_contacts fresh[])
{
    const size_t kind = w->grains.of[i] + (surface < w->walls ? 0U : (size_t)DIG_KINDS_MAX);
    return dig_contacts_add(&fresh[kind], i, (uint32_t)surface, (uint32_t)surface,
                            known[surface] == DIG_NO_SLOT ? NULL : &w->surface[kind],
                            known[surface]);
}

static enum dig_status pick_walls(const struct dig_world *const w, const uint32_t i,
                                  const double reach_m, const uint32_t known[],
                                  struct dig_contacts fresh[])
{
    const double *const x      = w->grains.motion[i].x_m;
    enum dig_status     status = DIG_OK;
    for (size_t s = 0; s < w->walls && status == DIG_OK; s++) {
        const double *const n = w->wall[s].normal;
        if (n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - w->wall[s].offset_m < reach_m) {
            status = add_surface(w, i, s, known, fresh);
        }
    }
    return status;
}

static enum dig_status pick_plates(const struct dig_world *const w, const uint32_t i,
                                   const double reach_m, const uint32_t known[],
                                   struct dig_contacts fresh[])
{
    const struct dig_tool *const tool  = w->tool;
    const double *const          x     = w->grains.motion[i].x_m;
    const double                 dx_m  = x[0] - tool->pose.x_m;
    const double                 dz_m  = x[2] - tool->pose.z_m;
    const double                 far_m = tool->radius_m + reach_m;
    if (dx_m * dx_m + dz_m * dz_m > far_m * far_m ||
        fabs(x[1]) > 0.5 * tool->bucket.width_m + reach_m) {
        return DIG_OK;
    }
    enum dig_status status = DIG_OK;
    double          body_m[3];
    dig_tool_to_body(tool, x, body_m);
    for (size_t p = 0; p < tool->plates && status == DIG_OK; p++) {
        double c[3];
        dig_tool_closest(tool, p, body_m, c);
        const double d[3] = { body_m[0] - c[0], body_m[1] - c[1], body_m[2] - c[2] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m) {
            status = add_surface(w, i, w->walls + p, known, fresh);
        }
    }
    return status;
}

enum dig_status dig_pick_surfaces(struct dig_world *const w)
{
    const struct dig_grains *const g        = &w->grains;
    const size_t                   surfaces = w->walls + (w->tool != NULL ? w->tool->plates : 0);
    uint32_t *const                was      = malloc((g->n * surfaces + 1) * sizeof *was);
    if (was == NULL) {
        return DIG_ENOMEM;
    }
    memset(was, 0xff, g->n * surfaces * sizeof *was);
    for (size_t k = 0; k < (size_t)2 * DIG_KINDS_MAX; k++) {
        for (size_t c = 0; c < w->surface[k].n; c++) {
            // Plates are beyond the end when the tool has been taken away.
            if (w->surface[k].j[c] < surfaces) {
                was[w->surface[k].i[c] * surfaces + w->surface[k].j[c]] = (uint32_t)c;
            }
        }
    }
    struct dig_contacts fresh[2 * DIG_KINDS_MAX] = { 0 };
    enum dig_status     status                   = DIG_OK;
    for (uint32_t i = 0; i < g->n && status == DIG_OK; i++) {
        const double          reach_m = g->kind[g->of[i]].radius_m + w->at_m[i][3];
        const uint32_t *const known   = was + i * surfaces;
        status                        = pick_walls(w, i, reach_m, known, fresh);
        if (w->tool != NULL && status == DIG_OK) {
            status = pick_plates(w, i, reach_m + w->tool_margin_m, known, fresh);
        }
    }
    free(was);
    adopt(status, (size_t)2 * DIG_KINDS_MAX, w->surface, fresh);
    return status;
}
