// The grounds of a table (gravel, effect, approach) and the curves of each as a set of entries in
// memory. Internal to tables/.

#ifndef DIG_TABLES_GROUNDS_H
#define DIG_TABLES_GROUNDS_H

#include "core/entry_set.h"
#include "core/error.h"
#include "tables/schema/schema.h"

#include <stdbool.h>

enum dig_grounds_kind {
    DIG_GROUNDS_PLAIN,      // without an effect, as the trajectories stand
    DIG_GROUNDS_VARIED,     // with an effect, likewise
    DIG_GROUNDS_APPROACHED, // without an effect, at another depth or attack
    DIG_GROUNDS_ALL,
};

/// Room for these entries, of the table's trajectories; NULL: no memory.
struct dig_entry_set *dig_grounds_create(const struct dig_table_head *head, size_t entries);

/// Reads and checks them; there may be none. NULL where the database has failed. Call it in a
/// transaction. Free with dig_entry_set_destroy().
struct dig_entry_set *dig_grounds_load(struct dig_db *db, const struct dig_table_head *head,
                                       enum dig_grounds_kind kind);

/// Gives entries with one packing the spread the others have at the same point of the path,
/// relative to the curve's rms: variances pooled by their degrees of freedom. others: grounds along
/// the same trajectories whose spread is added to the pool; NULL: none.
void dig_grounds_pool_spread(const struct dig_entry_set *others, struct dig_entry_set *grounds);

/// The time step of the head's scene against what the lightest of these gravels bears.
struct dig_table_step dig_grounds_step(const struct dig_entry_set  *grounds,
                                       const struct dig_table_head *head);

#endif // DIG_TABLES_GROUNDS_H
