// The digs of a table that are deeper or with the bucket turned, from an open database. Internal to
// tables/: dig_table_load() hangs them into the curve set.

#ifndef DIG_TABLES_LOAD_APPROACHES_H
#define DIG_TABLES_LOAD_APPROACHES_H

#include "core/approach_set.h"
#include "core/error.h"
#include "tables/schema/schema.h"

/// NULL into *set where the table holds none. Where an entry has one packing, its spread is pooled
/// from all that were dug without an effect. Call it in a transaction. Free with
/// dig_approach_set_destroy().
DIG_MUST_CHECK enum dig_status dig_sql_load_approaches(sqlite3 *db, const char *path,
                                                       const struct dig_table_head *head,
                                                       struct dig_approach_set    **set,
                                                       struct dig_error            *error);

/// NULL is allowed.
void dig_approach_set_destroy(struct dig_approach_set *set);

#endif // DIG_TABLES_LOAD_APPROACHES_H
