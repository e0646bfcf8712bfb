// What a store is, for the files of tables/ that share it.

#ifndef DIG_TABLES_STORE_PRIVATE_H
#define DIG_TABLES_STORE_PRIVATE_H

#include "tables/derive.h"
#include "tables/schema.h"
#include "tables/store.h"

#include <limits.h>

#define DIG_WINDOWS_MAX 1000000 // of one dig; a blob beyond it is damage

struct dig_store {
    sqlite3              *db;
    int                   lock_fd; // -1: opened to read
    struct dig_table_head head;
    char                  path[PATH_MAX];
};

/// Opens the file read-only, rolling back first what a crash left half written, and checks it.
DIG_MUST_CHECK enum dig_status dig_sql_open_read(const char *path, sqlite3 **db,
                                                 struct dig_table_head *head,
                                                 struct dig_error      *error);

/// dig_table_load() on an open database, which should be in a transaction.
DIG_MUST_CHECK enum dig_status dig_sql_load(sqlite3 *db, const char *path,
                                            const struct dig_table_head *head,
                                            struct dig_curve_set **set, struct dig_error *error);

/// The key of a gravel's row; DIG_EIO when there is none.
DIG_MUST_CHECK enum dig_status dig_gravel_find(const struct dig_store  *store,
                                               const struct dig_gravel *gravel, sqlite3_int64 *id,
                                               struct dig_error *error);

/// The mean and spread of all runs of one gravel and trajectory, added up by packing.
DIG_MUST_CHECK enum dig_status dig_entry_derive(struct dig_store *store, sqlite3_int64 gravel,
                                                size_t trajectory, struct dig_ensemble *ensemble,
                                                struct dig_error *error);

#endif // DIG_TABLES_STORE_PRIVATE_H
