#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/device_arrays.h"

#include <stdlib.h>

// What the members of a crew read from a view.
struct reading {
    struct dig_world             *world;
    const struct dig_device_view *view;
    uint32_t                     *count; // [members x DIG_PAIR_LISTS]
};

// Whether a pair of the view touches; the list of the world that has it, and whether there j is
// first.
static bool is_contact(const struct dig_device_view *const v, const size_t p, size_t *const list,
                       bool *const swapped)
{
    const size_t a = v->type_of[v->pair_i[p]];
    const size_t b = v->type_of[v->pair_j[p]];
    *swapped       = a > b;
    *list          = a <= b ? a * DIG_GRAIN_TYPES_MAX + b : b * DIG_GRAIN_TYPES_MAX + a;
    return v->touching[v->load_index[p][0]] != 0;
}

static void count_contacts(void *const context, const size_t member)
{
    const struct reading *const c     = context;
    uint32_t *const             count = c->count + member * DIG_PAIR_LISTS;
    const size_t                end   = dig_crew_share(c->world->crew, c->view->pairs, member + 1);
    for (size_t p = dig_crew_share(c->world->crew, c->view->pairs, member); p < end; p++) {
        size_t l;
        bool   swapped;
        if (is_contact(c->view, p, &l, &swapped)) {
            count[l]++;
        }
    }
}

// A member's contacts go to the places that place_contacts() has made of its counts.
static void read_contacts(void *const context, const size_t member)
{
    const struct reading *const         c    = context;
    const struct dig_device_view *const v    = c->view;
    uint32_t *const                     next = c->count + member * DIG_PAIR_LISTS;
    const size_t                        end  = dig_crew_share(c->world->crew, v->pairs, member + 1);
    for (size_t p = dig_crew_share(c->world->crew, v->pairs, member); p < end; p++) {
        size_t l;
        bool   swapped;
        if (is_contact(v, p, &l, &swapped)) {
            const uint32_t             at   = next[l]++;
            struct dig_contacts *const list = &c->world->pair[l];
            list->i[at]                     = swapped ? v->pair_j[p] : v->pair_i[p];
            list->j[at]                     = swapped ? v->pair_i[p] : v->pair_j[p];
            list->slot[at]                  = DIG_NO_SLOT;
            dig_contacts_set_history(
                list, at, dig_contact_history_times(v->pair_history[p], swapped ? -1.0 : 1.0));
        }
    }
}

static enum dig_status place_contacts(const struct reading *const c)
{
    enum dig_status status = DIG_OK;
    for (size_t l = 0; l < DIG_PAIR_LISTS && status == DIG_OK; l++) {
        uint32_t n = 0;
        for (size_t m = 0; m < dig_crew_members(c->world->crew); m++) {
            uint32_t *const count = &c->count[m * DIG_PAIR_LISTS + l];
            const uint32_t  of    = *count;
            *count                = n;
            n += of;
        }
        status = dig_contacts_reserve(&c->world->pair[l], n);
    }
    return status;
}

static enum dig_status read_pairs(struct reading *const c)
{
    struct dig_crew *const crew = c->world->crew;
    c->count                    = calloc(dig_crew_members(crew) * DIG_PAIR_LISTS, sizeof *c->count);
    if (c->count == NULL) {
        return DIG_ENOMEM;
    }
    dig_crew_run(crew, count_contacts, c);
    const enum dig_status status = place_contacts(c);
    if (status == DIG_OK) {
        dig_crew_run(crew, read_contacts, c);
    }
    free(c->count);
    return status;
}

static enum dig_status append(struct dig_contacts *const list, const uint32_t i,
                              const uint32_t                          surface,
                              const struct dig_contact_history *const history)
{
    const enum dig_status status = dig_contacts_add(list, i, surface, DIG_NO_SLOT, NULL, 0);
    if (status == DIG_OK) {
        dig_contacts_set_history(list, list->n - 1, *history);
    }
    return status;
}

static enum dig_status read_surfaces(const struct dig_device_view *const v,
                                     struct dig_world *const             w)
{
    const uint32_t  rocks  = v->walls + v->plates;
    enum dig_status status = DIG_OK;
    for (uint32_t i = 0; i < v->n; i++) {
        for (uint32_t s = 0; s < v->surfaces && v->surface_mask[i] >> s != 0 && status == DIG_OK;
             s++) {
            if ((v->surface_mask[i] >> s & 1) == 0) {
                continue;
            }
            const size_t   first  = s < v->walls ? 0 : s < rocks ? DIG_PLATE_LISTS : DIG_ROCK_LISTS;
            const uint32_t number = s < v->walls ? s
                                    : s < rocks  ? DIG_FIRST_PLATE + s - v->walls
                                                 : DIG_FIRST_ROCK + s - rocks;
            status                = append(&w->surface[first + v->type_of[i]], i, number,
                                           &v->surface_history[(size_t)s * v->n + i]);
        }
    }
    return status;
}

// Those of pairs are put anew.
static void clear_surface_lists(struct dig_world *const w)
{
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        w->surface[l].n = 0;
    }
}

enum dig_status dig_device_arrays_read(const struct dig_device_arrays *const arrays,
                                       struct dig_world *const               w)
{
    struct reading        reading = { .world = w, .view = &arrays->view };
    const enum dig_status status  = read_pairs(&reading);
    clear_surface_lists(w);
    return status == DIG_OK ? read_surfaces(&arrays->view, w) : status;
}
