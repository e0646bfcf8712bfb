#include "tables/merge.h"

#include "core/part.h"
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

// Runs of all inputs, by key. Temporary: the table itself is written once, in order.
static const char gather_sql[] =
    "CREATE TEMP TABLE gather (" KEY ", " DATA ", made_utc, wall_s, UNIQUE (" KEY "))";

static const char conflict_sql[] =
    "SELECT g.friction, g.rolling, g.density_kgpm3, g.effect, a.trajectory, a.packing, g.depth, "
    "g.attack_rad FROM src.run r JOIN src_ground g ON g.id = r.ground JOIN gather a ON "
    "(a.friction, a.rolling, a.density_kgpm3, a.effect, a.magnitude, a.depth, a.attack_rad, "
    "a.trajectory, a.packing) = (g.friction, g.rolling, g.density_kgpm3, g.effect, g.magnitude, "
    "g.depth, g.attack_rad, r.trajectory, r.packing) WHERE (r.seed, r.engine, "
    "r.version, r.grains, r.windows, r.first_s, r.step_s, r.curve) <> (a.seed, a.engine, "
    "a.version, a.grains, a.windows, a.first_s, a.step_s, a.curve) LIMIT 1";

static const char take_sql[] =
    "INSERT INTO gather SELECT " KEY ", " DATA ", made_utc, wall_s FROM src.run JOIN src_ground g "
    "ON g.id = run.ground WHERE true ON CONFLICT DO UPDATE SET made_utc = excluded.made_utc, "
    "wall_s = excluded.wall_s WHERE (excluded.made_utc, excluded.wall_s) < (made_utc, wall_s)";

static const char head_sql[] = "INSERT INTO main.scene SELECT * FROM src.scene;"
                               "INSERT INTO main.trajectory SELECT * FROM src.trajectory;"
                               "INSERT INTO main.phase SELECT * FROM src.phase ORDER BY 1, 2;";

static const char write_sql[] =
    "INSERT INTO ground (" DUG ") SELECT DISTINCT " DUG " FROM gather ORDER BY 1, 2, 3, 4, 5, 6, 7;"
    "INSERT INTO run (ground, trajectory, packing, " DATA ", made_utc, wall_s) SELECT g.id, "
    "trajectory, packing, " DATA ", made_utc, wall_s FROM gather a JOIN ground g ON (g.friction, "
    "g.rolling, g.density_kgpm3, g.effect, g.magnitude, g.depth, g.attack_rad) = (a.friction, "
    "a.rolling, a.density_kgpm3, a.effect, a.magnitude, a.depth, a.attack_rad) ORDER BY 1, 2, 3;";

static enum dig_status run(struct dig_store *const store, const char *const sql,
                           struct dig_error *const error)
{
    return dig_sql_run(store->db, store->path, sql, error);
}

#define URI_SIZE ((size_t)3 * PATH_MAX + 32)

// "file:PATH?mode=MODE", every byte that means something in it as %XX. What is longer no system
// opens.
static void uri_of(const char *const path, const char *const mode, char uri[const URI_SIZE])
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
    size_t used = strlen(path[0] == '/' ? "file://" : "file:./");
    memcpy(uri, path[0] == '/' ? "file://" : "file:./", used + 1);
    for (size_t i = 0; path[i] != '\0' && i < PATH_MAX; i++) {
        if (strchr(plain, path[i]) != NULL) {
            uri[used++] = path[i];
        } else {
            used += (size_t)snprintf(uri + used, URI_SIZE - used, "%%%02X", (unsigned char)path[i]);
        }
    }
    (void)snprintf(uri + used, URI_SIZE - used, "?mode=%s", mode);
}

static enum dig_status attach(struct dig_store *const store, const char *const input,
                              struct dig_error *const error)
{
    sqlite3_stmt *s = NULL;
    if (sqlite3_prepare_v2(store->db, "ATTACH ?1 AS src", -1, &s, NULL) != SQLITE_OK) {
        return dig_sql_refuse(store->db, store->path, error);
    }
    char uri[URI_SIZE];
    uri_of(input, "ro", uri);
    (void)sqlite3_bind_text(s, 1, uri, -1, SQLITE_STATIC);
    const enum dig_status status =
        sqlite3_step(s) == SQLITE_DONE ? DIG_OK : dig_sql_refuse(store->db, input, error);
    (void)sqlite3_finalize(s);
    return status;
}

// A run that is gathered already and differs in the attached input.
static enum dig_status check_conflict(const struct dig_store *const store, const char *const input,
                                      struct dig_error *const error)
{
    sqlite3_stmt *s = NULL;
    if (sqlite3_prepare_v2(store->db, conflict_sql, -1, &s, NULL) != SQLITE_OK) {
        return dig_sql_refuse(store->db, input, error);
    }
    enum dig_status status = DIG_OK;
    const int       step   = sqlite3_step(s);
    if (step == SQLITE_ROW) {
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
    } else if (step != SQLITE_DONE) {
        status = dig_sql_refuse(store->db, input, error);
    }
    (void)sqlite3_finalize(s);
    return status;
}

// The attached input's head, for the first, and its runs.
static enum dig_status take(struct dig_store *const store, const char *const input,
                            const bool is_first, struct dig_error *const error)
{
    enum dig_status status = attach(store, input, error);
    if (status != DIG_OK) {
        return status;
    }
    if (is_first) {
        status = run(store, head_sql, error);
    }
    if (status == DIG_OK) {
        status = dig_schema_view(store->db, input, "src", "src_ground", error);
    }
    if (status == DIG_OK) {
        status = check_conflict(store, input, error);
    }
    if (status == DIG_OK) {
        status = run(store, take_sql, error);
    }
    (void)sqlite3_exec(store->db, "DROP VIEW IF EXISTS temp.src_ground; DETACH src", NULL, NULL,
                       NULL);
    return status;
}

static enum dig_status refresh_entries(struct dig_store *const store, struct dig_error *const error)
{
    sqlite3_stmt *s = NULL;
    if (sqlite3_prepare_v2(store->db, "SELECT DISTINCT ground, trajectory FROM run ORDER BY 1, 2",
                           -1, &s, NULL) != SQLITE_OK) {
        return dig_sql_refuse(store->db, store->path, error);
    }
    enum dig_status status = DIG_OK;
    int             step   = SQLITE_DONE;
    while (status == DIG_OK && (step = sqlite3_step(s)) == SQLITE_ROW) {
        status = dig_entry_refresh(store, sqlite3_column_int64(s, 0),
                                   (size_t)sqlite3_column_int64(s, 1), error);
    }
    if (status == DIG_OK && step != SQLITE_DONE) {
        status = dig_sql_refuse(store->db, store->path, error);
    }
    (void)sqlite3_finalize(s);
    return status;
}

static enum dig_status fill(struct dig_store *const store, const size_t inputs,
                            const char *const input[const], struct dig_error *const error)
{
    enum dig_status status = run(store, gather_sql, error);
    for (size_t i = 0; status == DIG_OK && i < inputs; i++) {
        status = take(store, input[i], i == 0, error);
    }
    static const char *const rest[] = { "BEGIN", write_sql };
    for (size_t i = 0; status == DIG_OK && i < sizeof rest / sizeof rest[0]; i++) {
        status = run(store, rest[i], error);
    }
    if (status == DIG_OK) {
        status = refresh_entries(store, error);
    }
    if (status == DIG_OK) {
        status = run(store, "COMMIT", error);
    }
    return status == DIG_OK ? run(store, "VACUUM", error) : status;
}

// Every input a sound table of one scene; its head is the store's.
static enum dig_status check_inputs(struct dig_store *const store, const size_t inputs,
                                    const char *const input[const], struct dig_error *const error)
{
    for (size_t i = 0; i < inputs; i++) {
        sqlite3              *db     = NULL;
        struct dig_table_head head   = { .trajectories = 0 };
        const enum dig_status status = dig_sql_open_read(input[i], &db, &head, error);
        if (status != DIG_OK) {
            return status;
        }
        (void)sqlite3_close(db);
        if (i == 0) {
            store->head = head;
        } else if (strcmp(head.scene_hash, store->head.scene_hash) != 0) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s: scene: holds \"%s\" (%.12s…), expected that of %s, \"%s\" "
                                 "(%.12s…)",
                                 input[i], head.scene_name, head.scene_hash, input[0],
                                 store->head.scene_name, store->head.scene_hash);
        }
    }
    return DIG_OK;
}

static enum dig_status merge_into(struct dig_store *const store, const size_t inputs,
                                  const char *const input[const], struct dig_error *const error)
{
    FILE *const made = dig_part_open(store->path);
    if (made == NULL || fclose(made) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
    }
    char uri[URI_SIZE];
    uri_of(store->path, "rw", uri);
    if (sqlite3_open_v2(uri, &store->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_URI, NULL) !=
        SQLITE_OK) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path,
                             store->db != NULL ? sqlite3_errmsg(store->db) : "no memory");
    }
    enum dig_status status = dig_sql_setup(store->db, store->path, error);
    if (status == DIG_OK) {
        status = dig_schema_tables(store->db, store->path, DIG_TABLE_VERSION, error);
    }
    if (status == DIG_OK) {
        status = dig_schema_number(store->db, store->path, error);
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
    enum dig_status status = check_inputs(store, inputs, input, error);
    if (status == DIG_OK) {
        status = merge_into(store, inputs, input, error);
        (void)sqlite3_close(store->db);
        store->db = NULL;
        if (status == DIG_OK && rename(store->path, path) != 0) {
            status =
                dig_error_set(error, DIG_EIO, "%s: cannot be renamed to %s", store->path, path);
        }
        if (status != DIG_OK) {
            (void)unlink(store->path);
        }
    }
    free(store);
    return status;
}
