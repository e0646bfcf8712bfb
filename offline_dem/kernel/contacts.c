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
        .key  = grow(list->key, list->n, room, sizeof *more.key),
    };
    int ok = more.i != NULL && more.j != NULL && more.key != NULL;
    for (int m = 0; m < DIG_MEMORIES; m++) {
        more.memory[m] = grow(list->memory[m], list->n, room, sizeof(double));
        ok             = ok && more.memory[m] != NULL;
    }
    if (!ok) {
        dig_contacts_finish(&more);
        return DIG_ENOMEM;
    }
    dig_contacts_finish(list);
    *list = more;
    return DIG_OK;
}

void dig_contacts_finish(struct dig_contacts *const list)
{
    if (list == NULL) {
        return;
    }
    free(list->i);
    free(list->j);
    free(list->key);
    for (int m = 0; m < DIG_MEMORIES; m++) {
        free(list->memory[m]);
    }
    *list = (struct dig_contacts){ 0 };
}
