// Contact list: pairs that may touch before the next contact detection, with their histories. A
// structure of arrays, which the law reads and writes as vectors. One list holds contacts of one
// pair of grain types, whose law they share.

#ifndef DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
#define DIG_OFFLINE_DEM_KERNEL_CONTACTS_H

#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_NO_SLOT        UINT32_MAX // of a contact whose pair is in no neighbour list
#define DIG_BLOCK          64         // contacts computed together: their operands fit the L1 cache
#define DIG_HISTORY_VALUES 6          // values of a struct dig_contact_history

struct dig_contacts {
    size_t    n;
    size_t    room;                        // a multiple of DIG_BLOCK
    uint32_t *i;                           // grain
    uint32_t *j;                           // grain, or surface
    uint32_t *slot;                        // place in the neighbour list
    double   *history[DIG_HISTORY_VALUES]; // sx sy sz mx my mz
};

/// Grows the list. DIG_ENOMEM leaves it as it was.
DIG_MUST_CHECK enum dig_status dig_contacts_grow(struct dig_contacts *list);

/// Appends a contact with the history of contact `at` of `from` (NULL: zero). DIG_ENOMEM leaves the
/// list as it was. Inline, because contact detection appends every contact.
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

/// Maps grains to their new indices: new_index[old], UINT32_MAX where a grain is removed, and its
/// contacts with it. j is a grain in a list of pairs, else a surface. Slots become DIG_NO_SLOT.
void dig_contacts_renumber(struct dig_contacts *list, bool pairs, const uint32_t new_index[]);

void dig_contacts_finish(struct dig_contacts *list);

#endif // DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
