#include "offline_dem/kernel/contacts.h"

#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64

static void *grow(void *const old, const size_t used, const size_t room, const size_t size)
{
    void *const p = aligned_alloc(ALIGNMENT, room * size);
    if (p != NULL) {
        memset(p, 0, room * size);
        if (used > 0) {
            memcpy(p, old, used * size);
        }
    }
    return p;
}

enum dig_status dig_contacts_grow(struct dig_contacts *const list, const size_t n)
{
    const size_t        room = (2 * n / DIG_BLOCK + 8) * DIG_BLOCK;
    struct dig_contacts more = {
        .n      = list->n,
        .room   = room,
        .i      = grow(list->i, list->n, room, sizeof *more.i),
        .j      = grow(list->j, list->n, room, sizeof *more.j),
        .slot   = grow(list->slot, list->n, room, sizeof *more.slot),
        .single = list->single,
        .slabs  = list->slabs,
    };
    bool ok = more.i != NULL && more.j != NULL && more.slot != NULL;
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        more.any_history[m] = grow(list->any_history[m], list->n, room,
                                   list->single ? sizeof(float) : sizeof(double));
        ok                  = ok && more.any_history[m] != NULL;
    }
    if (!ok) {
        dig_contacts_finish(&more);
        return DIG_ENOMEM;
    }
    more.slab_first  = list->slab_first;
    list->slab_first = NULL;
    dig_contacts_finish(list);
    *list = more;
    return DIG_OK;
}

enum dig_status dig_contacts_reserve(struct dig_contacts *const list, const size_t n)
{
    if (n > list->room && dig_contacts_grow(list, n) != DIG_OK) {
        return DIG_ENOMEM;
    }
    list->n = n;
    return DIG_OK;
}

enum dig_status dig_contacts_set_slabs(struct dig_contacts *const list, const size_t slabs)
{
    if (list->slabs == slabs && list->slab_first != NULL) {
        return DIG_OK;
    }
    uint32_t *const first = calloc(slabs + 1, sizeof *first);
    if (first == NULL) {
        return DIG_ENOMEM;
    }
    free(list->slab_first);
    list->slab_first = first;
    list->slabs      = slabs;
    return DIG_OK;
}

void dig_contacts_renumber(struct dig_contacts *const list, const bool pairs,
                           const uint32_t new_index[])
{
    size_t kept = 0;
    for (size_t c = 0; c < list->n; c++) {
        const uint32_t i = new_index[list->i[c]];
        const uint32_t j = pairs ? new_index[list->j[c]] : list->j[c];
        if (i == UINT32_MAX || j == UINT32_MAX) {
            continue;
        }
        list->i[kept]    = i;
        list->j[kept]    = j;
        list->slot[kept] = DIG_NO_SLOT;
        if (kept < c) {
            dig_contacts_set_history(list, kept, dig_contacts_history(list, c));
        }
        kept++;
    }
    list->n = kept;
}

void dig_contacts_finish(struct dig_contacts *const list)
{
    if (list == NULL) {
        return;
    }
    free(list->i);
    free(list->j);
    free(list->slot);
    free(list->slab_first);
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        free(list->any_history[m]);
    }
    *list = (struct dig_contacts){ 0 };
}
