// Pairs close enough to touch soon, with what each contact remembers: structure of arrays, so that
// the law reads and writes whole vectors. One list holds contacts of one kind pair only, so the
// law's constants are the same for all of it.

#ifndef DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
#define DIG_OFFLINE_DEM_KERNEL_CONTACTS_H

#include "core/status.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_BLOCK          64 // contacts computed together: their operands stay in the first cache
#define DIG_HISTORY_VALUES 6  // numbers of a struct dig_contact_history

struct dig_contacts {
    size_t    n;
    size_t    room;                        // a multiple of DIG_BLOCK
    uint32_t *i;                           // grain
    uint32_t *j;                           // grain, or surface
    uint32_t *slot;                        // finds the contact again when the list is made anew
    double   *history[DIG_HISTORY_VALUES]; // sx sy sz mx my mz
};

/// Makes room for more contacts than there are. DIG_ENOMEM leaves the list as it was.
DIG_MUST_CHECK enum dig_status dig_contacts_grow(struct dig_contacts *list);

/// Appends with the memories that contact `at` of `from` has (NULL: zero). DIG_ENOMEM leaves the
/// list as it was. Here, because a pick appends every contact there is.
DIG_MUST_CHECK static inline enum dig_status
dig_contacts_add(struct dig_contacts *const list, const uint32_t i, const uint32_t j,
                 const uint32_t slot, const struct dig_contacts *const from, const uint32_t at)
{
    if (list->n == list->room && dig_contacts_grow(list) != DIG_OK) {
        return DIG_ENOMEM;
    }
    const size_t n = list->n++;
    list->i[n]     = i;
    list->j[n]     = j;
    list->slot[n]  = slot;
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        list->history[m][n] = from == NULL ? 0.0 : from->history[m][at];
    }
    return DIG_OK;
}

void dig_contacts_finish(struct dig_contacts *list);

#endif // DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
