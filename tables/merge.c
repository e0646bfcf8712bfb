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

#define DUG  "friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad"
#define KEY  DUG ", trajectory, packing"
#define DATA "seed, engine, version, grains, windows, first_s, step_s, curve"

// Runs by key, and those of the input at hand. Temporary: the table itself is written once, in
// order.
static const char gather_sql[] =
    "CREATE TEMP TABLE gather (" KEY ", " DATA ", made_utc, wall_s, UNIQUE (" KEY "));"
    "CREATE TEMP TABLE came (" KEY ", " DATA ", made_utc, wall_s);";

static const char runs_sql[] = "SELECT " KEY ", " DATA ", made_utc, wall_s FROM run JOIN ground g "
                               "ON g.id = run.ground";

static const char conflict_sql[] =
    "SELECT friction, rolling, density_kgpm3, effect, trajectory, packing, depth, attack_rad FROM "
    "came c JOIN gather a USING (" KEY ") WHERE (c.seed, c.engine, c.version, c.grains, c.windows, "
    "c.first_s, c.step_s, c.curve) <> (a.seed, a.engine, a.version, a.grains, a.windows, "
    "a.first_s, a.step_s, a.curve) LIMIT 1";

static const char take_sql[] =
    "INSERT INTO gather SELECT * FROM came WHERE true ON CONFLICT DO UPDATE SET made_utc = "
    "excluded.made_utc, wall_s = excluded.wall_s WHERE (excluded.made_utc, excluded.wall_s) < "
    "(made_utc, wall_s); DELETE FROM came;";

static const char write_sql[] =
    "INSERT INTO ground (" DUG ") SELECT DISTINCT " DUG " FROM gather ORDER BY 1, 2, 3, 4, 5, 6, 7;"
    "INSERT INTO run (ground, trajectory, packing, " DATA ", made_utc, wall_s) SELECT g.id, "
    "trajectory, packing, " DATA ", made_utc, wall_s FROM gather a JOIN ground g ON (g.friction, "
    "g.rolling, g.density_kgpm3, g.effect, g.magnitude, g.depth, g.attack_rad) = (a.friction, "
    "a.rolling, a.density_kgpm3, a.effect, a.magnitude, a.depth, a.attack_rad) ORDER BY 1, 2, 3;";

static enum dig_status run(struct dig_store *const store, const char *const sql,
                           struct dig_error *const error)
{
    return dig_sql_run(&store->db, sql, error);
}

// Every row that a statement gives of one database becomes one of another's table.
static enum dig_status copy(const struct dig_db *const from, const char *const select,
                            const struct dig_db *const to, const char *const insert,
                            struct dig_error *const error)
{
    sqlite3_stmt   *row    = NULL;
    sqlite3_stmt   *into   = NULL;
    enum dig_status status = dig_sql_prepare(from, select, &row, error);
    if (status == DIG_OK) {
        status = dig_sql_prepare(to, insert, &into, error);
    }
    while (dig_sql_row(from, row, &status, error)) {
        for (int i = 0; i < sqlite3_column_count(row); i++) {
            (void)sqlite3_bind_value(into, i + 1, sqlite3_column_value(row, i));
        }
        if (sqlite3_step(into) != SQLITE_DONE) {
            status = dig_sql_refuse(to, error);
        }
        (void)sqlite3_reset(into);
    }
    (void)sqlite3_finalize(row);
    (void)sqlite3_finalize(into);
    return status;
}

// A run that is gathered already and differs in the input at hand.
static enum dig_status check_conflict(const struct dig_store *const store, const char *const input,
                                      struct dig_error *const error)
{
    const struct dig_db named  = { store->db.sql, input };
    sqlite3_stmt       *s      = NULL;
    enum dig_status     status = dig_sql_prepare(&named, conflict_sql, &s, error);
    if (dig_sql_row(&named, s, &status, error)) {
        const char *const         effect = (const char *)sqlite3_column_text(s, 3);
        const bool                plain  = effect == NULL || effect[0] == '\0';
        const int                 at     = sqlite3_column_int(s, 4);
        char                      how[DIG_APPROACH_TEXT_SIZE];
        const struct dig_approach approach = { sqlite3_column_double(s, 6),
                                               sqlite3_column_double(s, 7) };
        dig_approach_text(&approach, how);
        status = dig_error_set(
            error, DIG_EINVAL,
            "%s: run: packing %lld of friction %g, rolling %g, %g kg/m3%s%s on %s%s differs from "
            "another input's, expected the same run or another",
            input, (long long)sqlite3_column_int64(s, 5), sqlite3_column_double(s, 0),
            sqlite3_column_double(s, 1), sqlite3_column_double(s, 2), plain ? "" : " with ",
            plain ? "" : effect,
            at >= 0 && at < (int)store->head.trajectories ? store->head.trajectory[at].name : "?",
            how);
    }
    (void)sqlite3_finalize(s);
    return status;
}

// Of the first input the store becomes a table of its scene; of any other it has to be that.
static enum dig_status take_head(struct dig_store *const store, const struct dig_db *const from,
                                 const char *const input[const], const size_t at,
                                 const struct dig_table_head *const head,
                                 struct dig_error *const            error)
{
    if (at > 0) {
        return strcmp(head->scene_hash, store->head.scene_hash) == 0
                   ? DIG_OK
                   : dig_error_set(error, DIG_EINVAL,
                                   "%s: scene: holds \"%s\" (%.12s…), expected that of %s, \"%s\" "
                                   "(%.12s…)",
                                   input[at], head->scene_name, head->scene_hash, input[0],
                                   store->head.scene_name, store->head.scene_hash);
    }
    static const char *const copies[][2] = {
        { "SELECT * FROM scene", "INSERT INTO scene VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)" },
        { "SELECT * FROM trajectory", "INSERT INTO trajectory VALUES (?, ?, ?, ?, ?)" },
        { "SELECT * FROM phase ORDER BY 1, 2", "INSERT INTO phase VALUES (?, ?, ?, ?, ?, ?, ?)" },
    };
    enum dig_status status = DIG_OK;
    for (size_t i = 0; status == DIG_OK && i < sizeof copies / sizeof copies[0]; i++) {
        status = copy(from, copies[i][0], &store->db, copies[i][1], error);
    }
    store->head = *head;
    return status;
}

// An input's head and runs, in the transaction in which it was found sound: by its name it could be
// another file a moment later.
static enum dig_status take(struct dig_store *const store, const char *const input[const],
                            const size_t at, struct dig_error *const error)
{
    struct dig_db         from   = { .sql = NULL };
    struct dig_table_head head   = { .trajectories = 0 };
    enum dig_status       status = dig_sql_open_read(input[at], &from, &head, error);
    if (status == DIG_OK) {
        status = take_head(store, &from, input, at, &head, error);
    }
    if (status == DIG_OK) {
        status =
            copy(&from, runs_sql, &store->db,
                 "INSERT INTO came VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                 "?)",
                 error);
    }
    (void)sqlite3_close(from.sql);
    if (status == DIG_OK) {
        status = check_conflict(store, input[at], error);
    }
    return status == DIG_OK ? run(store, take_sql, error) : status;
}

static enum dig_status refresh_entries(struct dig_store *const store, struct dig_error *const error)
{
    sqlite3_stmt   *s      = NULL;
    enum dig_status status = dig_sql_prepare(
        &store->db, "SELECT DISTINCT ground, trajectory FROM run ORDER BY 1, 2", &s, error);
    while (dig_sql_row(&store->db, s, &status, error)) {
        status = dig_entry_refresh(store, sqlite3_column_int64(s, 0),
                                   (size_t)sqlite3_column_int64(s, 1), error);
    }
    (void)sqlite3_finalize(s);
    return status;
}

static enum dig_status fill(struct dig_store *const store, const size_t inputs,
                            const char *const input[const], struct dig_error *const error)
{
    enum dig_status status = run(store, gather_sql, error);
    if (status == DIG_OK) {
        status = run(store, "BEGIN", error);
    }
    for (size_t i = 0; status == DIG_OK && i < inputs; i++) {
        status = take(store, input, i, error);
    }
    if (status == DIG_OK) {
        status = run(store, write_sql, error);
    }
    if (status == DIG_OK) {
        status = refresh_entries(store, error);
    }
    if (status == DIG_OK) {
        status = run(store, "COMMIT", error);
    }
    return status == DIG_OK ? run(store, "VACUUM", error) : status;
}

static enum dig_status merge_into(struct dig_store *const store, const size_t inputs,
                                  const char *const input[const], struct dig_error *const error)
{
    FILE *const made = dig_part_open(store->path);
    if (made == NULL || fclose(made) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
    }
    enum dig_status status = dig_sql_open(store->path, SQLITE_OPEN_READWRITE, &store->db, error);
    if (status == DIG_OK) {
        status = dig_schema_tables(&store->db, DIG_TABLE_VERSION, error);
    }
    if (status == DIG_OK) {
        status = dig_schema_number(&store->db, error);
    }
    return status == DIG_OK ? fill(store, inputs, input, error) : status;
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
