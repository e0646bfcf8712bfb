// Seals every entry of a table that a test has changed.

#ifndef DIG_TESTS_SEAL_ALL_H
#define DIG_TESTS_SEAL_ALL_H

#include "tables/schema/seal.h"

/// What cannot be read is left without a seal.
static inline void seal_all_of(sqlite3 *const sql, const char *const path)
{
    struct dig_db db = { .sql = sql, .path = path };
    sqlite3_stmt *s  = dig_sql_prepare(&db, "SELECT ground, trajectory FROM entry ORDER BY 1, 2");
    while (dig_sql_row(&db, s)) {
        dig_seal_write(&db, sqlite3_column_int64(s, 0), (size_t)sqlite3_column_int64(s, 1));
    }
    (void)sqlite3_finalize(s);
}

static inline void seal_all(const char *const path)
{
    sqlite3 *sql = NULL;
    if (sqlite3_open(path, &sql) == SQLITE_OK) {
        seal_all_of(sql, path);
    }
    (void)sqlite3_close(sql);
}

#endif // DIG_TESTS_SEAL_ALL_H
