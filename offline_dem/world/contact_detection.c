#include "offline_dem/world/contact_detection.h"

#include "offline_dem/kernel/crew.h"
#include "offline_dem/law/period.h"
#include "offline_dem/shapes/bucket_surface.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The kernel reads eight contacts at a time: padding beyond the last one must name grains that
// exist.
static void pad_list(struct dig_contacts *const list)
{
    for (size_t c = list->n; c % 8 != 0; c++) {
        list->i[c] = 0;
        list->j[c] = 0;
    }
}

// On success replaces the lists by the new ones; else drops these. The arrays that are left are
// filled next time.
static void swap_lists(const enum dig_status status, const size_t lists, struct dig_contacts old[],
                       struct dig_contacts fresh[])
{
    for (size_t l = 0; l < lists; l++) {
        if (status == DIG_OK) {
            const struct dig_contacts before = old[l];
            old[l]                           = fresh[l];
            fresh[l]                         = before;
            pad_list(&old[l]);
        }
        fresh[l].n = 0;
    }
}

// Lists of a bed with so many slabs, one for each pair of its grain types, or three for each type.
static enum dig_status set_slabs(const struct dig_grains *const grains, const bool pairs,
                                 struct dig_contacts list[])
{
    enum dig_status status = DIG_OK;
    for (size_t a = 0; a < grains->types && status == DIG_OK; a++) {
        for (size_t b = pairs ? a : 0; b < (pairs ? grains->types : 3) && status == DIG_OK; b++) {
            const size_t l = pairs ? a * DIG_GRAIN_TYPES_MAX + b : b * DIG_GRAIN_TYPES_MAX + a;
            status         = dig_contacts_set_slabs(&list[l], grains->slabs.count);
        }
    }
    return status;
}

// What follows is of this slab.
static void begin_slab(const size_t lists, const size_t slab, struct dig_contacts list[])
{
    for (size_t l = 0; l < lists; l++) {
        if (list[l].slab_first != NULL) {
            list[l].slab_first[slab] = (uint32_t)list[l].n;
        }
    }
}

// A table of `need` entries, all UINT32_MAX.
static enum dig_status make_room(uint32_t **const table, size_t *const room, const size_t need)
{
    if (need <= *room && *table != NULL) {
        return DIG_OK;
    }
    const size_t    more = need + need / 4 + 64;
    uint32_t *const made = malloc(more * sizeof *made);
    if (made == NULL) {
        return DIG_ENOMEM;
    }
    memset(made, 0xff, more * sizeof *made);
    free(*table);
    *table = made;
    *room  = more;
    return DIG_OK;
}

// Writes where each contact of a list stands, or resets these entries.
static void index_list(const struct dig_contacts *const list, const bool clear, uint32_t old[])
{
    for (size_t c = 0; c < list->n; c++) {
        if (list->slot[c] != DIG_NO_SLOT) {
            old[list->slot[c]] = clear ? UINT32_MAX : (uint32_t)c;
        }
    }
}

static void index_pairs(struct dig_world *const w, const bool clear)
{
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        index_list(&w->pair[l], clear, w->detection.old_pair);
    }
}

// The near pairs of grain i. Every pair is written and only near ones are counted: a branch would
// be mispredicted every third time.
static size_t find_near_pairs(const struct dig_world *const w, const uint32_t i,
                              uint32_t near_pairs[])
{
    const struct dig_grains *const     g          = &w->grains;
    const struct dig_neighbours *const neighbours = &w->neighbours;
    const double *const                x          = dig_grains_position(g, i);
    const double own_m          = g->type[g->type_of[i]].radius_m + w->reference_m[i][3];
    const double inverse_period = dig_period_inverse(w->period_y_m);
    size_t       count          = 0;
    for (uint32_t s = neighbours->start[i]; s < neighbours->start[i + 1]; s++) {
        const uint32_t      j    = neighbours->other[s];
        const double *const y    = dig_grains_position(g, j);
        const double        dy_m = dig_period_fold(x[1] - y[1], w->period_y_m, inverse_period);
        const double        d[3] = { x[0] - y[0], dy_m, x[2] - y[2] };
        const double reach_m     = own_m + g->type[g->type_of[j]].radius_m + w->reference_m[j][3];
        near_pairs[count]        = s;
        count += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m;
    }
    return count;
}

// The list of a pair, and its grains in order: unlike types stand in the order of the types.
static size_t list_of(const struct dig_world *const w, const uint32_t i, const uint32_t s,
                      uint32_t *const a, uint32_t *const b)
{
    const uint8_t *const type_of = w->grains.type_of;
    const uint32_t       j       = w->neighbours.other[s];
    const bool           swapped = type_of[i] > type_of[j];
    *a                           = swapped ? j : i;
    *b                           = swapped ? i : j;
    return (size_t)type_of[*a] * DIG_GRAIN_TYPES_MAX + type_of[*b];
}

// First look at the grains of a slab: near pairs, and how many for each list.
static void find_slab_pairs(struct dig_world *const w, const size_t slab)
{
    struct dig_contact_detection *const d     = &w->detection;
    uint32_t *const                     count = d->count + slab * DIG_PAIR_LISTS;
    memset(count, 0, DIG_PAIR_LISTS * sizeof *count);
    const size_t end = dig_grains_slab_first(&w->grains, slab + 1);
    for (size_t i = dig_grains_slab_first(&w->grains, slab); i < end; i++) {
        uint32_t *const near = d->near_pairs + w->neighbours.start[i];
        d->near_count[i]     = (uint32_t)find_near_pairs(w, (uint32_t)i, near);
        for (size_t c = 0; c < d->near_count[i]; c++) {
            uint32_t a = 0;
            uint32_t b = 0;
            count[list_of(w, (uint32_t)i, near[c], &a, &b)]++;
        }
    }
}

// Second look: each near pair goes to its place, with its history.
static void put_slab_pairs(struct dig_world *const w, const size_t slab)
{
    struct dig_contact_detection *const d    = &w->detection;
    uint32_t *const                     next = d->count + slab * DIG_PAIR_LISTS;
    const size_t                        end  = dig_grains_slab_first(&w->grains, slab + 1);
    for (size_t i = dig_grains_slab_first(&w->grains, slab); i < end; i++) {
        const uint32_t *const near = d->near_pairs + w->neighbours.start[i];
        for (size_t c = 0; c < d->near_count[i]; c++) {
            uint32_t       a   = 0;
            uint32_t       b   = 0;
            const size_t   l   = list_of(w, (uint32_t)i, near[c], &a, &b);
            const uint32_t old = d->old_pair[near[c]];
            dig_contacts_put(&d->pair[l], next[l]++, a, b, near[c],
                             old == DIG_NO_SLOT ? NULL : &w->pair[l], old);
        }
    }
}

static void find_pairs(void *const context, const size_t first, const size_t end)
{
    for (size_t slab = first; slab < end; slab++) {
        find_slab_pairs(context, slab);
    }
}

static void put_pairs(void *const context, const size_t first, const size_t end)
{
    for (size_t slab = first; slab < end; slab++) {
        put_slab_pairs(context, slab);
    }
}

// Places of the slabs in every list, in their order; count becomes the place of the slab's first.
static enum dig_status place_slabs(struct dig_world *const w)
{
    enum dig_status status = DIG_OK;
    for (size_t l = 0; l < DIG_PAIR_LISTS && status == DIG_OK; l++) {
        struct dig_contacts *const list = &w->detection.pair[l];
        uint32_t                   n    = 0;
        for (size_t slab = 0; slab < w->grains.slabs.count && list->slab_first != NULL; slab++) {
            uint32_t *const count  = &w->detection.count[slab * DIG_PAIR_LISTS + l];
            const uint32_t  of     = *count;
            list->slab_first[slab] = n;
            *count                 = n;
            n += of;
        }
        if (list->slab_first != NULL) {
            list->slab_first[w->grains.slabs.count] = n;
        }
        status = dig_contacts_reserve(list, n);
    }
    return status;
}

enum dig_status dig_contact_detection_pairs(struct dig_world *const w)
{
    struct dig_contact_detection *const d     = &w->detection;
    const size_t                        n     = w->grains.n;
    const size_t                        slots = w->neighbours.start[n];
    const size_t                        lists = w->grains.slabs.count * DIG_PAIR_LISTS;
    if (make_room(&d->old_pair, &d->pair_room, slots + 1) != DIG_OK ||
        make_room(&d->near_pairs, &d->near_room, slots + 1) != DIG_OK ||
        make_room(&d->near_count, &d->near_count_room, n + 1) != DIG_OK ||
        make_room(&d->count, &d->count_room, lists) != DIG_OK ||
        set_slabs(&w->grains, true, d->pair) != DIG_OK) {
        return DIG_ENOMEM;
    }
    dig_crew_each(w->crew, w->grains.slabs.count, find_pairs, w);
    const enum dig_status status = place_slabs(w);
    if (status == DIG_OK) {
        index_pairs(w, false);
        dig_crew_each(w->crew, w->grains.slabs.count, put_pairs, w);
        index_pairs(w, true);
    }
    swap_lists(status, DIG_PAIR_LISTS, w->pair, d->pair);
    return status;
}

static enum dig_status add_surface(struct dig_world *const w, const uint32_t i,
                                   const uint32_t number, const uint32_t old_index[])
{
    const size_t   l   = w->grains.type_of[i] + (number < DIG_FIRST_PLATE  ? 0
                                                 : number < DIG_FIRST_ROCK ? DIG_PLATE_LISTS
                                                                           : DIG_ROCK_LISTS);
    const uint32_t old = old_index[dig_world_surface(w, number)];
    return dig_contacts_add(&w->detection.surface[l], i, number, number,
                            old == DIG_NO_SLOT ? NULL : &w->surface[l], old);
}

static enum dig_status detect_walls(struct dig_world *const w, const uint32_t i,
                                    const double reach_m, const uint32_t old_index[])
{
    const double *const x      = dig_grains_position(&w->grains, i);
    enum dig_status     status = DIG_OK;
    for (uint32_t s = 0; s < w->walls && status == DIG_OK; s++) {
        const double *const n = w->wall[s].normal;
        if (n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - w->wall[s].offset_m < reach_m) {
            status = add_surface(w, i, s, old_index);
        }
    }
    return status;
}

static enum dig_status detect_plates(struct dig_world *const w, const uint32_t i,
                                     const double reach_m, const uint32_t old_index[])
{
    const struct dig_tool *const tool  = w->tool;
    const double *const          x     = dig_grains_position(&w->grains, i);
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
    for (uint32_t p = 0; p < tool->plates && status == DIG_OK; p++) {
        double c[3];
        dig_bucket_closest(&tool->bucket, p, body_m, c);
        const double d[3] = { body_m[0] - c[0], body_m[1] - c[1], body_m[2] - c[2] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_m * reach_m) {
            status = add_surface(w, i, DIG_FIRST_PLATE + p, old_index);
        }
    }
    return status;
}

static enum dig_status detect_rocks(struct dig_world *const w, const uint32_t i,
                                    const double reach_m, const uint32_t old_index[])
{
    const struct dig_obstacles *const o      = &w->bodies->obstacles;
    const double *const               x      = dig_grains_position(&w->grains, i);
    enum dig_status                   status = DIG_OK;
    for (uint32_t r = 0; r < o->rocks && status == DIG_OK; r++) {
        if (dig_obstacles_is_near(o, w, r, x, reach_m)) {
            status = add_surface(w, i, DIG_FIRST_ROCK + r, old_index);
        }
    }
    return status;
}

static void index_surfaces(struct dig_world *const w, const size_t surfaces, const bool clear)
{
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        const struct dig_contacts *const list = &w->surface[l];
        for (size_t c = 0; c < list->n; c++) {
            const size_t surface = dig_world_surface(w, list->j[c]);
            if (surface < surfaces) {
                w->detection.old_surface[list->i[c] * surfaces + surface] =
                    clear ? UINT32_MAX : (uint32_t)c;
            }
        }
    }
}

enum dig_status dig_contact_detection_surfaces(struct dig_world *const w)
{
    const struct dig_grains *const g        = &w->grains;
    const size_t                   rocks    = dig_bodies_rocks(w->bodies);
    const size_t                   surfaces = dig_world_surface(w, DIG_FIRST_ROCK) + rocks;
    if (make_room(&w->detection.old_surface, &w->detection.surface_room, g->n * surfaces + 1) !=
        DIG_OK) {
        return DIG_ENOMEM;
    }
    enum dig_status status = set_slabs(g, false, w->detection.surface);
    if (status != DIG_OK) {
        return status;
    }
    index_surfaces(w, surfaces, false);
    if (rocks > 0) {
        dig_obstacles_set_margins(&w->bodies->obstacles, w->dt_s);
    }
    for (uint32_t i = 0; i < g->n && status == DIG_OK; i++) {
        if (i % g->slabs.grains == 0) {
            begin_slab(DIG_SURFACE_LISTS, i / g->slabs.grains, w->detection.surface);
        }
        const double          reach_m   = g->type[g->type_of[i]].radius_m + w->reference_m[i][3];
        const uint32_t *const old_index = w->detection.old_surface + i * surfaces;
        status                          = detect_walls(w, i, reach_m, old_index);
        if (w->tool != NULL && status == DIG_OK) {
            status = detect_plates(w, i, reach_m + w->tool_margin_m, old_index);
        }
        if (rocks > 0 && status == DIG_OK) {
            status = detect_rocks(w, i, reach_m, old_index);
        }
    }
    begin_slab(DIG_SURFACE_LISTS, g->slabs.count, w->detection.surface);
    index_surfaces(w, surfaces, true);
    swap_lists(status, DIG_SURFACE_LISTS, w->surface, w->detection.surface);
    return status;
}

static void finish_lists(const size_t lists, struct dig_contacts list[])
{
    for (size_t l = 0; l < lists; l++) {
        dig_contacts_finish(&list[l]);
    }
}

void dig_contact_detection_finish(struct dig_contact_detection *const detection)
{
    free(detection->old_pair);
    free(detection->old_surface);
    free(detection->near_pairs);
    free(detection->near_count);
    free(detection->count);
    finish_lists(DIG_PAIR_LISTS, detection->pair);
    finish_lists(DIG_SURFACE_LISTS, detection->surface);
    *detection = (struct dig_contact_detection){ 0 };
}
