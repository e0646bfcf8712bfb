// Contact list: pairs that may touch before the next contact detection, with their histories. A
// structure of arrays, which the law reads and writes as vectors. One list holds contacts of one
// pair of grain types, whose law they share.

#ifndef DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
#define DIG_OFFLINE_DEM_KERNEL_CONTACTS_H

#include "core/status.h"
#include "offline_dem/law/law.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_NO_SLOT        UINT32_MAX // of a contact whose pair is in no neighbour list
#define DIG_BLOCK          64         // contacts computed together: their operands fit the L1 cache
#define DIG_HISTORY_VALUES 6          // values of a struct dig_contact_history

struct dig_contacts {
    size_t    n;
    size_t    room; // a multiple of DIG_BLOCK
    uint32_t *i;    // grain
    uint32_t *j;    // grain, or surface
    uint32_t *slot; // place in the neighbour list
    // Contacts of slab s (grains.h) are slab_first[s] … slab_first[s + 1] - 1. NULL: all are of the
    // only slab.
    uint32_t *slab_first; // [slabs + 1]
    size_t    slabs;
    // sx sy sz mx my mz: in single precision in single_history, else in history.
    bool single; // set while the list is empty
    union {
        void   *any_history[DIG_HISTORY_VALUES];
        double *history[DIG_HISTORY_VALUES];
        float  *single_history[DIG_HISTORY_VALUES];
    };
};

static inline struct dig_contact_history dig_contacts_history(const struct dig_contacts *const list,
                                                              const size_t                     c)
{
    if (list->single) {
        float *const *const h = list->single_history;
        return (struct dig_contact_history){ h[0][c], h[1][c], h[2][c], h[3][c], h[4][c], h[5][c] };
    }
    double *const *const h = list->history;
    return (struct dig_contact_history){ h[0][c], h[1][c], h[2][c], h[3][c], h[4][c], h[5][c] };
}

/// Rounds the history in a list of single precision.
static inline void dig_contacts_set_history(struct dig_contacts *const list, const size_t c,
                                            const struct dig_contact_history history)
{
    const double value[DIG_HISTORY_VALUES] = { history.sx_m,  history.sy_m,  history.sz_m,
                                               history.mx_Nm, history.my_Nm, history.mz_Nm };
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        if (list->single) {
            list->single_history[m][c] = (float)value[m];
        } else {
            list->history[m][c] = value[m];
        }
    }
}

static inline size_t dig_contacts_slab_first(const struct dig_contacts *const list,
                                             const size_t                     slab)
{
    return list->slab_first == NULL ? slab * list->n : list->slab_first[slab];
}

/// Room for the marks of so many slabs. DIG_ENOMEM leaves the list as it was.
DIG_MUST_CHECK enum dig_status dig_contacts_set_slabs(struct dig_contacts *list, size_t slabs);

/// Makes room for so many contacts, and for more to come. DIG_ENOMEM leaves the list as it was.
DIG_MUST_CHECK enum dig_status dig_contacts_grow(struct dig_contacts *list, size_t n);

/// Makes it n contacts, which are to be put. DIG_ENOMEM leaves the list as it was.
DIG_MUST_CHECK enum dig_status dig_contacts_reserve(struct dig_contacts *list, size_t n);

/// Writes contact c with the history of contact `at` of `from`, a list of the same precision (NULL:
/// zero). Inline, because contact detection writes every contact.
static inline void dig_contacts_put(struct dig_contacts *const list, const size_t c,
                                    const uint32_t i, const uint32_t j, const uint32_t slot,
                                    const struct dig_contacts *const from, const uint32_t at)
{
    list->i[c]    = i;
    list->j[c]    = j;
    list->slot[c] = slot;
    if (list->single) {
        for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
            list->single_history[m][c] = from == NULL ? 0.0F : from->single_history[m][at];
        }
    } else {
        for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
            list->history[m][c] = from == NULL ? 0.0 : from->history[m][at];
        }
    }
}

/// Appends a contact likewise. DIG_ENOMEM leaves the list as it was.
DIG_MUST_CHECK static inline enum dig_status
dig_contacts_add(struct dig_contacts *const list, const uint32_t i, const uint32_t j,
                 const uint32_t slot, const struct dig_contacts *const from, const uint32_t at)
{
    if (list->n == list->room && dig_contacts_grow(list, list->n + 1) != DIG_OK) {
        return DIG_ENOMEM;
    }
    dig_contacts_put(list, list->n++, i, j, slot, from, at);
    return DIG_OK;
}

/// Maps grains to their new indices: new_index[old], UINT32_MAX where a grain is removed, and its
/// contacts with it. j is a grain in a list of pairs, else a surface. Slots become DIG_NO_SLOT.
void dig_contacts_renumber(struct dig_contacts *list, bool pairs, const uint32_t new_index[]);

void dig_contacts_finish(struct dig_contacts *list);

#endif // DIG_OFFLINE_DEM_KERNEL_CONTACTS_H
