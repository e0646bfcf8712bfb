// Restricts what a file can do through a connection, and checks its schema: a table may come from
// anybody.

#include "tables/schema/schema.h"

#include <string.h>

#define LENGTH_MAX 33554432 // of a row: the longest run has half of it
#define SQL_MAX    65536

void dig_sql_setup(struct dig_db *const db)
{
    static const int off[] = {
        SQLITE_DBCONFIG_TRUSTED_SCHEMA,
        SQLITE_DBCONFIG_ENABLE_TRIGGER,
        SQLITE_DBCONFIG_ENABLE_VIEW,
        SQLITE_DBCONFIG_ENABLE_FTS3_TOKENIZER,
        SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION,
        SQLITE_DBCONFIG_DQS_DDL,
        SQLITE_DBCONFIG_DQS_DML,
    };
    static const int limit[][2] = {
        { SQLITE_LIMIT_LENGTH, LENGTH_MAX },
        { SQLITE_LIMIT_SQL_LENGTH, SQL_MAX },
        { SQLITE_LIMIT_COLUMN, 64 },
        { SQLITE_LIMIT_EXPR_DEPTH, 100 },
        { SQLITE_LIMIT_COMPOUND_SELECT, 4 },
        { SQLITE_LIMIT_VDBE_OP, 100000 },
        { SQLITE_LIMIT_FUNCTION_ARG, 8 },
        { SQLITE_LIMIT_ATTACHED, 1 },
        { SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 100 },
        { SQLITE_LIMIT_VARIABLE_NUMBER, 64 },
        { SQLITE_LIMIT_TRIGGER_DEPTH, 1 },
        { SQLITE_LIMIT_WORKER_THREADS, 0 },
    };
    (void)sqlite3_db_config(db->sql, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    for (size_t i = 0; i < sizeof off / sizeof off[0]; i++) {
        (void)sqlite3_db_config(db->sql, off[i], 0, NULL);
    }
    for (size_t i = 0; i < sizeof limit / sizeof limit[0]; i++) {
        (void)sqlite3_limit(db->sql, limit[i][0], limit[i][1]);
    }
    (void)sqlite3_busy_timeout(db->sql, 5000);
    dig_sql_run(db, "PRAGMA foreign_keys = ON; PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0;");
}

static const char objects_sql[] =
    "SELECT type, name, tbl_name, replace(ifnull(sql, ''), 'TABLE \x22ground\x22', 'TABLE ground') "
    "FROM main.sqlite_schema ORDER BY 1, 2";

static const char *text_at(sqlite3_stmt *const s, const int column)
{
    const char *const text = (const char *)sqlite3_column_text(s, column);
    return text != NULL ? text : "";
}

static void refuse(struct dig_db *const db, sqlite3_stmt *const object, const char *const what)
{
    dig_db_fail(db, DIG_EINVAL, "schema: %.20s \"%.60s\" is %s", text_at(object, 0),
                text_at(object, 1), what);
}

// By type, then name, as both statements are ordered.
static int order_of(sqlite3_stmt *const a, sqlite3_stmt *const b)
{
    const int types = strcmp(text_at(a, 0), text_at(b, 0));
    return types != 0 ? types : strcmp(text_at(a, 1), text_at(b, 1));
}

// Both statements give the objects of a database; both end when both are alike.
static void compare(sqlite3_stmt *const found, sqlite3_stmt *const expected,
                    struct dig_db *const db)
{
    while (db->status == DIG_OK) {
        const int is     = sqlite3_step(found);
        const int should = sqlite3_step(expected);
        if ((is != SQLITE_ROW && is != SQLITE_DONE) ||
            (should != SQLITE_ROW && should != SQLITE_DONE)) {
            dig_sql_refuse(db);
            return;
        }
        if (is == SQLITE_DONE && should == SQLITE_DONE) {
            return;
        }
        const int order = is == SQLITE_DONE       ? 1
                          : should == SQLITE_DONE ? -1
                                                  : order_of(found, expected);
        if (order < 0) {
            refuse(db, found, "not digtable's, expected its tables alone");
        } else if (order > 0) {
            refuse(db, expected, "missing, expected it");
        } else if (strcmp(text_at(found, 2), text_at(expected, 2)) != 0 ||
                   strcmp(text_at(found, 3), text_at(expected, 3)) != 0) {
            refuse(db, found, "not as digtable makes it, expected that");
        }
    }
}

void dig_schema_compare(struct dig_db *const db)
{
    struct dig_db ours = { .path = db->path, .status = db->status, .error = db->error };
    if (sqlite3_open_v2(":memory:", &ours.sql, SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY, NULL) !=
        SQLITE_OK) {
        dig_db_fail(&ours, DIG_ENOMEM, "no memory");
    }
    dig_schema_tables(&ours);
    sqlite3_stmt *const expected = dig_sql_prepare(&ours, objects_sql);
    sqlite3_stmt *const found    = dig_sql_prepare(db, objects_sql);
    db->status                   = ours.status != DIG_OK ? ours.status : db->status;
    compare(found, expected, db);
    (void)sqlite3_finalize(found);
    (void)sqlite3_finalize(expected);
    (void)sqlite3_close(ours.sql);
}
