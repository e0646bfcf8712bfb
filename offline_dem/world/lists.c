#include "offline_dem/world/lists.h"

#include "offline_dem/kernel/cell_grid.h"
#include "offline_dem/kernel/crew.h"
#include "offline_dem/law/period.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/contact_detection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Margins trade rebuilds against idle contacts. Fastest on a bed of 7000 grains being dug
// (docs/numerics/dem.md); in double precision what the tables that ship were dug with. The most of
// a margin keeps grains that fall from many idle contacts.
struct margins {
    struct dig_skin neighbour, contact;
};

static const struct margins margins_double = { { 0.16, 100.0, INFINITY },
                                               { 0.008, 20.0, INFINITY } };
static const struct margins margins_single = { { 0.2, 200.0, 0.7 }, { 0.006, 80.0, 0.12 } };

static const struct margins *margins_of(const struct dig_world *const w)
{
    return w->single ? &margins_single : &margins_double;
}

// Cells along which grains are sorted. In single precision the reach of most pairs, so that these
// lie in neighbouring layers of cells, and near each other in memory; in double precision what the
// tables that ship were dug with.
#define SORT_RADII        2.0
#define SORT_RADII_SINGLE 2.35

static double speed(const struct dig_grains *const grains, const size_t i)
{
    const struct dig_motion m = dig_grains_motion(grains, i);
    return sqrt(m.v_mps[0] * m.v_mps[0] + m.v_mps[1] * m.v_mps[1] + m.v_mps[2] * m.v_mps[2]);
}

static double margin(const struct dig_world *const w, const struct dig_skin *const skin,
                     const size_t i)
{
    const double radius_m = w->grains.type[w->grains.type_of[i]].radius_m;
    const double moving_m = skin->steps * w->dt_s * speed(&w->grains, i);
    return fmin(skin->radii * radius_m + moving_m, skin->most_radii * radius_m);
}

void dig_lists_renumber(struct dig_world *const w, const uint32_t new_index[])
{
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        dig_contacts_renumber(&w->pair[l], true, new_index);
    }
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        dig_contacts_renumber(&w->surface[l], false, new_index);
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
    return DIG_NO_SLOT;
}

// A rebuild of the neighbour list, whose work the world's crew shares.
struct rebuild {
    struct dig_world    *world;
    struct dig_skin      skin;
    uint32_t            *order;     // [grains] the grain that comes to this place
    uint32_t            *new_index; // [grains]
    double              *margin;    // [grains]
    struct dig_contacts *list;      // whose slots are found
    bool                 like;      // its grains are of one type
};

// Slot of each contact in the new neighbour list. A pair listed in the other order is swapped.
static void find_slots(void *const context, const size_t first, const size_t end)
{
    const struct rebuild *const        r    = context;
    const struct dig_neighbours *const near = &r->world->neighbours;
    struct dig_contacts *const         list = r->list;
    for (size_t c = first; c < end; c++) {
        const uint32_t i    = list->i[c];
        const uint32_t j    = list->j[c];
        uint32_t       slot = find_slot(near, i, j);
        if (slot == DIG_NO_SLOT) {
            slot = find_slot(near, j, i);
            if (r->like && slot != DIG_NO_SLOT) {
                list->i[c] = j;
                list->j[c] = i;
                dig_contacts_set_history(
                    list, c, dig_contact_history_times(dig_contacts_history(list, c), -1.0));
            }
        }
        list->slot[c] = slot;
    }
}

// Moves grains that have left through a periodic side to the other.
static void wrap(void *const context, const size_t first, const size_t end)
{
    struct dig_world *const w              = context;
    const double            inverse_period = dig_period_inverse(w->period_y_m);
    for (size_t i = first; i < end; i++) {
        double *const y_m = &w->grains.motion[i].x_m[1];
        *y_m              = dig_period_fold(*y_m, w->period_y_m, inverse_period);
    }
}

static void widen(void *const context, const size_t first, const size_t end)
{
    const struct rebuild *const r = context;
    for (size_t i = first; i < end; i++) {
        r->margin[i] = margin(r->world, &r->skin, i);
    }
}

// Grains and neighbours; contacts still have the grains' old indices.
static enum dig_status sort(struct rebuild *const r)
{
    struct dig_world *const w            = r->world;
    const size_t            n            = w->grains.n;
    double                  radius_max_m = 0.0;
    for (size_t k = 0; k < w->grains.types; k++) {
        radius_max_m = fmax(radius_max_m, w->grains.type[k].radius_m);
    }
    if (w->period_y_m > 0.0) {
        dig_crew_each(w->crew, n, wrap, w);
    }
    enum dig_status status = dig_cell_grid_sort(
        &w->grains, (w->single ? SORT_RADII_SINGLE : SORT_RADII) * radius_max_m, w->crew, r->order);
    status = status == DIG_OK ? dig_grains_reorder(&w->grains, r->order, w->crew) : status;
    if (status != DIG_OK) {
        return status;
    }
    for (size_t k = 0; k < n; k++) {
        r->new_index[r->order[k]] = (uint32_t)k;
    }
    dig_bodies_renumber(w->bodies, r->new_index);
    dig_crew_each(w->crew, n, widen, r);
    w->list_rebuilds++;
    return dig_neighbours_build(&w->grains, w->period_y_m, r->margin, w->crew, &w->neighbours);
}

static void find_all_slots(struct rebuild *const r)
{
    struct dig_world *const w = r->world;
    dig_lists_renumber(w, r->new_index);
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        r->list = &w->pair[l];
        r->like = l / DIG_GRAIN_TYPES_MAX == l % DIG_GRAIN_TYPES_MAX;
        if (r->list->n > 0) {
            dig_crew_each(w->crew, r->list->n, find_slots, r);
        }
    }
    if (w->single) {
        dig_grains_set_slabs(&w->grains, w->neighbours.reach);
    }
}

static enum dig_status rebuild(struct dig_world *const w, const struct dig_skin skin,
                               uint32_t order[], const bool with_contacts)
{
    const size_t   n = w->grains.n;
    struct rebuild r = {
        .world     = w,
        .skin      = skin,
        .new_index = calloc(n + 1, sizeof *r.new_index),
        .margin    = malloc((n + 1) * sizeof *r.margin),
    };
    r.order                  = order;
    const bool      has_room = r.new_index != NULL && r.margin != NULL;
    enum dig_status status   = has_room ? sort(&r) : DIG_ENOMEM;
    if (status == DIG_OK && with_contacts) {
        find_all_slots(&r);
    }
    free(r.new_index);
    free(r.margin);
    return status;
}

enum dig_status dig_lists_rebuild(struct dig_world *const w, const struct dig_skin skin)
{
    uint32_t *const       order  = malloc((w->grains.n + 1) * sizeof *order);
    const enum dig_status status = order != NULL ? rebuild(w, skin, order, true) : DIG_ENOMEM;
    free(order);
    return status;
}

enum dig_status dig_lists_sort(struct dig_world *const w, const struct dig_skin skin,
                               uint32_t order[])
{
    return rebuild(w, skin, order, false);
}

// Whether the neighbour list covers the contact margins: each grain's displacement since and its
// margin now fit into its margin then.
static bool is_covered(const struct dig_world *const w)
{
    if (w->neighbours.n != w->grains.n || w->neighbours.start == NULL) {
        return false;
    }
    for (size_t i = 0; i < w->grains.n; i++) {
        const double *const x    = dig_grains_position(&w->grains, i);
        const double *const was  = w->neighbours.reference_m[i];
        const double        d[3] = { x[0] - was[0], x[1] - was[1], x[2] - was[2] };
        const double        left = was[3] - w->reference_m[i][3];
        if (!(left > 0.0 && d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < left * left)) {
            return false;
        }
    }
    return true;
}

static void set_margins(struct dig_world *const w)
{
    const struct dig_skin *const skin = &margins_of(w)->contact;
    for (size_t i = 0; i < w->grains.n; i++) {
        memcpy(w->reference_m[i], dig_grains_position(&w->grains, i), 3 * sizeof(double));
        w->reference_m[i][3] = margin(w, skin, i);
    }
    if (w->tool != NULL) {
        const double speed_mps =
            hypot(w->tool->vx_mps, w->tool->vz_mps) + w->tool->radius_m * fabs(w->tool->w_radps);
        w->tool_reference = w->tool->pose;
        w->tool_margin_m =
            skin->radii * w->grains.type[0].radius_m + 2.0 * skin->steps * w->dt_s * speed_mps;
    }
}

enum dig_status dig_lists_update(struct dig_world *const w)
{
    const size_t n = w->grains.n;
    if (w->reference_room < n + 1) {
        double(*const reference)[4] = realloc(w->reference_m, (n + 1) * sizeof *reference);
        if (reference == NULL) {
            return DIG_ENOMEM;
        }
        w->reference_m    = reference;
        w->reference_room = n + 1;
    }
    set_margins(w);
    if (!is_covered(w)) {
        dig_grains_end_single(&w->grains);
        const enum dig_status status = dig_lists_rebuild(w, margins_of(w)->neighbour);
        if (status != DIG_OK) {
            return status;
        }
        set_margins(w);
    }
    enum dig_status status = dig_contact_detection_pairs(w);
    if (status == DIG_OK) {
        status = dig_contact_detection_surfaces(w);
    }
    if (status == DIG_OK) {
        w->stale = false;
        w->contact_rebuilds++;
    }
    return status;
}

void dig_lists_finish(struct dig_world *const w)
{
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        dig_contacts_finish(&w->pair[l]);
    }
    for (size_t k = 0; k < DIG_SURFACE_LISTS; k++) {
        dig_contacts_finish(&w->surface[k]);
    }
    dig_contact_detection_finish(&w->detection);
    dig_neighbours_finish(&w->neighbours);
    free(w->reference_m);
    w->reference_m    = NULL;
    w->reference_room = 0;
}
