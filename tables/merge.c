#include "tables/merge.h"

#include "core/part.h"
#include "tables/open.h"
#include "tables/store_private.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Runs by key, and those of the input at hand. Temporary: the table itself is written once, in
// order.
static const char gather_sql[] =
    "CREATE TEMP TABLE gather (" DIG_KEY_COLUMNS ", " DIG_MADE_COLUMNS ", UNIQUE (" DIG_KEY_COLUMNS
    "));"
    "CREATE TEMP TABLE came (" DIG_KEY_COLUMNS ", " DIG_MADE_COLUMNS ");";

static const char runs_sql[] =
    "SELECT " DIG_KEY_COLUMNS ", " DIG_MADE_COLUMNS " FROM run JOIN ground g "
    "ON g.id = run.ground";

static const char conflict_sql[] =
    "SELECT " DIG_KEY_COLUMNS " FROM came c JOIN gather a USING (" DIG_KEY_COLUMNS ") WHERE "
    "(c.seed, c.engine, c.version, c.grains, c.windows, c.first_s, c.step_s, c.curve) <> "
    "(a.seed, a.engine, a.version, a.grains, a.windows, a.first_s, a.step_s, a.curve) LIMIT 1";

static const char take_sql[] =
    "INSERT INTO gather SELECT * FROM came WHERE true ON CONFLICT DO UPDATE SET made_utc = "
    "excluded.made_utc, wall_s = excluded.wall_s WHERE (excluded.made_utc, excluded.wall_s) < "
    "(made_utc, wall_s); DELETE FROM came;";

static const char write_sql[] =
    "INSERT INTO ground (" DIG_GROUND_COLUMNS ") SELECT DISTINCT " DIG_GROUND_COLUMNS
    " FROM gather ORDER BY 1, 2, 3, 4, 5, 6, 7;"
    "INSERT INTO run (ground, trajectory, packing, " DIG_MADE_COLUMNS ") SELECT g.id, trajectory, "
    "packing, " DIG_MADE_COLUMNS " FROM gather JOIN ground g USING (" DIG_GROUND_COLUMNS ") "
    "ORDER BY 1, 2, 3;";

// Every row that a statement gives of one database becomes one of another's table.
static void copy(struct dig_db *const from, const char *const select, struct dig_db *const to,
                 const char *const insert)
{
    sqlite3_stmt *const row  = dig_sql_prepare(from, select);
    sqlite3_stmt *const into = dig_sql_prepare(to, insert);
    while (to->status == DIG_OK && dig_sql_row(from, row)) {
        for (int i = 0; i < sqlite3_column_count(row); i++) {
            (void)sqlite3_bind_value(into, i + 1, sqlite3_column_value(row, i));
        }
        if (sqlite3_step(into) != SQLITE_DONE) {
            dig_sql_refuse(to);
        }
        (void)sqlite3_reset(into);
    }
    (void)sqlite3_finalize(row);
    (void)sqlite3_finalize(into);
}

// A run that is gathered already and differs in the input at hand.
static void check_conflict(struct dig_store *const store, const char *const input)
{
    struct dig_db       named = { store->db.sql, input, store->db.status, store->db.error };
    sqlite3_stmt *const s     = dig_sql_prepare(&named, conflict_sql);
    if (dig_sql_row(&named, s)) {
        struct dig_run run = { .windows = 0 };
        char           text[DIG_RUN_TEXT_SIZE];
        (void)dig_run_read(s, DIG_RUN_SEED, &run);
        dig_run_text(store, &run.origin, text);
        dig_db_fail(&named, DIG_EINVAL,
                    "run: packing %zu of %s differs from another input's, expected the same run or "
                    "another",
                    run.origin.packing, text);
    }
    (void)sqlite3_finalize(s);
    store->db.status = named.status;
}

// Of the first input the store becomes a table of its scene; of any other it has to be that.
static void take_head(struct dig_store *const store, struct dig_db *const from,
                      const char *const input[const], const size_t at,
                      const struct dig_table_head *const head)
{
    if (at > 0) {
        if (strcmp(head->scene_hash, store->head.scene_hash) != 0) {
            dig_db_fail(from, DIG_EINVAL,
                        "scene: holds \"%s\" (%.12s…), expected that of %s, \"%s\" (%.12s…)",
                        head->scene_name, head->scene_hash, input[0], store->head.scene_name,
                        store->head.scene_hash);
        }
        return;
    }
    copy(from, "SELECT * FROM scene", &store->db,
         "INSERT INTO scene VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
    copy(from, "SELECT * FROM trajectory", &store->db,
         "INSERT INTO trajectory VALUES (?, ?, ?, ?, ?)");
    copy(from, "SELECT * FROM phase ORDER BY 1, 2", &store->db,
         "INSERT INTO phase VALUES (?, ?, ?, ?, ?, ?, ?)");
    store->head = *head;
}

// An input's head and runs, in the transaction in which it was found sound: by its name it could be
// another file a moment later.
static void take(struct dig_store *const store, const char *const input[const], const size_t at)
{
    struct dig_db *const  db   = &store->db;
    struct dig_table_head head = { .trajectories = 0 };
    struct dig_db         from = dig_sql_open_read(input[at], &head, db->error);
    if (from.status == DIG_OK) {
        take_head(store, &from, input, at, &head);
        copy(&from, runs_sql, db,
             "INSERT INTO came VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    }
    (void)sqlite3_close(from.sql);
    db->status = from.status != DIG_OK ? from.status : db->status;
    check_conflict(store, input[at]);
    dig_sql_run(db, take_sql);
}

static void refresh_entries(struct dig_store *const store)
{
    struct dig_db *const db = &store->db;
    sqlite3_stmt *const  s =
        dig_sql_prepare(db, "SELECT DISTINCT ground, trajectory FROM run ORDER BY 1, 2");
    while (dig_sql_row(db, s)) {
        dig_entry_refresh(store, sqlite3_column_int64(s, 0), (size_t)sqlite3_column_int64(s, 1));
    }
    (void)sqlite3_finalize(s);
}

static enum dig_status fill(struct dig_store *const store, const size_t inputs,
                            const char *const input[const])
{
    struct dig_db *const db = &store->db;
    dig_sql_run(db, gather_sql);
    dig_sql_run(db, "BEGIN");
    for (size_t i = 0; db->status == DIG_OK && i < inputs; i++) {
        take(store, input, i);
    }
    dig_sql_run(db, write_sql);
    refresh_entries(store);
    dig_sql_run(db, "COMMIT");
    dig_sql_run(db, "VACUUM");
    return db->status;
}

static enum dig_status merge_into(struct dig_store *const store, const size_t inputs,
                                  const char *const input[const], struct dig_error *const error)
{
    FILE *const made = dig_part_open(store->path);
    if (made == NULL || fclose(made) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
    }
    store->db = (struct dig_db){ .path = store->path, .error = error };
    dig_sql_open(&store->db, SQLITE_OPEN_READWRITE);
    dig_schema_tables(&store->db);
    return fill(store, inputs, input);
}

enum dig_status dig_store_merge(const char *const path, const size_t inputs,
                                const char *const input[const], struct dig_error *const error)
{
    assert(path != NULL && inputs > 0 && input != NULL);
    if (access(path, F_OK) == 0) {
        return dig_error_set(error, DIG_EINVAL, "%s: exists, expected a new file", path);
    }
    struct dig_store *const store = calloc(1, sizeof *store);
    if (store == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    store->lock_fd   = -1;
    const int length = snprintf(store->path, sizeof store->path, "%s.part", path);
    if (length < 0 || (size_t)length >= sizeof store->path) {
        free(store);
        return dig_error_set(error, DIG_EINVAL, "%s: the name is too long", path);
    }
    enum dig_status status = merge_into(store, inputs, input, error);
    (void)sqlite3_close(store->db.sql);
    if (status == DIG_OK && rename(store->path, path) != 0) {
        status = dig_error_set(error, DIG_EIO, "%s: cannot be renamed to %s", store->path, path);
    }
    if (status != DIG_OK) {
        (void)unlink(store->path);
    }
    free(store);
    return status;
}
