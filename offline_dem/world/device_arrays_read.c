#include "offline_dem/world/bodies.h"
#include "offline_dem/world/device_arrays.h"

// Appends a contact with its history as the first of the two has it, times sign.
static enum dig_status append(struct dig_contacts *const list, const uint32_t i, const uint32_t j,
                              const struct dig_contact_history *const history, const double sign)
{
    const enum dig_status status = dig_contacts_add(list, i, j, DIG_NO_SLOT, NULL, 0);
    if (status == DIG_OK) {
        dig_contacts_set_history(list, list->n - 1, dig_contact_history_times(*history, sign));
    }
    return status;
}

// Unlike types stand in the order of the types.
static enum dig_status read_pairs(const struct dig_device_view *const v, struct dig_world *const w)
{
    enum dig_status status = DIG_OK;
    for (size_t p = 0; p < v->pairs && status == DIG_OK; p++) {
        const uint32_t i       = v->pair_i[p];
        const uint32_t j       = v->pair_j[p];
        const bool     swapped = v->type_of[i] > v->type_of[j];
        const size_t   low     = v->type_of[swapped ? j : i];
        const size_t   high    = v->type_of[swapped ? i : j];
        if (v->touching[v->load_index[p][0]] != 0) {
            status = append(&w->pair[low * DIG_GRAIN_TYPES_MAX + high], swapped ? j : i,
                            swapped ? i : j, &v->pair_history[p], swapped ? -1.0 : 1.0);
        }
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
                                           &v->surface_history[(size_t)s * v->n + i], 1.0);
        }
    }
    return status;
}

enum dig_status dig_device_arrays_read(const struct dig_device_arrays *const arrays,
                                       struct dig_world *const               w)
{
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        w->pair[l].n = 0;
    }
    for (size_t l = 0; l < DIG_SURFACE_LISTS; l++) {
        w->surface[l].n = 0;
    }
    const enum dig_status status = read_pairs(&arrays->view, w);
    return status == DIG_OK ? read_surfaces(&arrays->view, w) : status;
}
