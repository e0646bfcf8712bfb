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

enum dig_status dig_contacts_grow(struct dig_contacts *const list)
{
    const size_t        room = 2 * list->room + (size_t)8 * DIG_BLOCK;
    struct dig_contacts more = {
        .n    = list->n,
        .room = room,
        .i    = grow(list->i, list->n, room, sizeof *more.i),
        .j    = grow(list->j, list->n, room, sizeof *more.j),
        .slot = grow(list->slot, list->n, room, sizeof *more.slot),
    };
    int ok = more.i != NULL && more.j != NULL && more.slot != NULL;
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        more.history[m] = grow(list->history[m], list->n, room, sizeof(double));
        ok              = ok && more.history[m] != NULL;
    }
    if (!ok) {
        dig_contacts_finish(&more);
        return DIG_ENOMEM;
    }
    dig_contacts_finish(list);
    *list = more;
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
        for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
            list->history[m][kept] = list->history[m][c];
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
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        free(list->history[m]);
    }
    *list = (struct dig_contacts){ 0 };
}
