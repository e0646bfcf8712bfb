#include "tables/schema/schema.h"

#include "tables/schema/seal.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// What all versions have alike.
static const char common_sql[] = "CREATE TABLE scene ("
                                 "  id INTEGER PRIMARY KEY CHECK (id = 1),"
                                 "  name TEXT NOT NULL,"
                                 "  hash TEXT NOT NULL CHECK (length(hash) = 64),"
                                 "  canonical TEXT NOT NULL,"
                                 "  tooth_m REAL NOT NULL,"
                                 "  bucket_width_m REAL NOT NULL,"
                                 "  young_Pa REAL NOT NULL,"
                                 "  smooth_half_s REAL NOT NULL,"
                                 "  points INTEGER NOT NULL"
                                 ") STRICT;"
                                 "CREATE TABLE trajectory ("
                                 "  id INTEGER PRIMARY KEY,"
                                 "  name TEXT NOT NULL UNIQUE,"
                                 "  theta0_rad REAL NOT NULL,"
                                 "  start_x_m REAL NOT NULL,"
                                 "  start_z_m REAL NOT NULL"
                                 ") STRICT;"
                                 "CREATE TABLE phase ("
                                 "  trajectory INTEGER NOT NULL REFERENCES trajectory (id),"
                                 "  number INTEGER NOT NULL,"
                                 "  name TEXT NOT NULL,"
                                 "  duration_s REAL NOT NULL,"
                                 "  vx_mps REAL NOT NULL,"
                                 "  vz_mps REAL NOT NULL,"
                                 "  omega_radps REAL NOT NULL,"
                                 "  PRIMARY KEY (trajectory, number)"
                                 ") STRICT;"
                                 "CREATE TABLE run ("
                                 "  id INTEGER PRIMARY KEY,"
                                 "  ground INTEGER NOT NULL REFERENCES ground (id),"
                                 "  trajectory INTEGER NOT NULL REFERENCES trajectory (id),"
                                 "  packing INTEGER NOT NULL CHECK (packing >= 0),"
                                 "  seed INTEGER NOT NULL,"
                                 "  engine TEXT NOT NULL,"
                                 "  version TEXT NOT NULL,"
                                 "  grains INTEGER NOT NULL,"
                                 "  windows INTEGER NOT NULL CHECK (windows >= 2),"
                                 "  first_s REAL NOT NULL,"
                                 "  step_s REAL NOT NULL CHECK (step_s > 0),"
                                 "  curve BLOB NOT NULL,"
                                 "  made_utc TEXT NOT NULL,"
                                 "  wall_s REAL NOT NULL,"
                                 "  UNIQUE (ground, trajectory, packing)"
                                 ") STRICT;"
                                 "CREATE TABLE entry ("
                                 "  ground INTEGER NOT NULL REFERENCES ground (id),"
                                 "  trajectory INTEGER NOT NULL REFERENCES trajectory (id),"
                                 "  packings INTEGER NOT NULL CHECK (packings > 0),"
                                 "  mean BLOB NOT NULL,"
                                 "  spread BLOB CHECK ((spread IS NULL) = (packings = 1)),"
                                 "  PRIMARY KEY (ground, trajectory)"
                                 ") STRICT;";

static const char plain_ground_sql[] =
    "CREATE TABLE ground ("
    "  id INTEGER PRIMARY KEY,"
    "  friction REAL NOT NULL,"
    "  rolling REAL NOT NULL,"
    "  density_kgpm3 REAL NOT NULL,"
    "  effect TEXT NOT NULL,"
    "  magnitude REAL NOT NULL CHECK (effect <> '' OR magnitude = 0),"
    "  UNIQUE (friction, rolling, density_kgpm3, effect, magnitude)"
    ") STRICT;";

enum dig_status dig_sql_refuse(const struct dig_db *const db, struct dig_error *const error)
{
    const int code = sqlite3_errcode(db->sql);
    if (code == SQLITE_NOMEM) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", db->path);
    }
    if (code == SQLITE_NOTADB) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: not a digsight table, expected a file made by digtable",
                             db->path);
    }
    if (code == SQLITE_CORRUPT) {
        return dig_error_set(error, DIG_EINVAL, "%s: damaged: %s, expected an intact table",
                             db->path, sqlite3_errmsg(db->sql));
    }
    const int extended = sqlite3_extended_errcode(db->sql);
    if (code == SQLITE_CANTOPEN || extended == SQLITE_IOERR_SHMOPEN ||
        extended == SQLITE_IOERR_SHMSIZE || extended == SQLITE_IOERR_SHMMAP) {
        return dig_error_set(error, DIG_EIO,
                             "%s: it, or a journal beside it, cannot be opened, expected regular "
                             "files and a journal of this table alone",
                             db->path);
    }
    return dig_error_set(error, DIG_EIO, "%s: %s", db->path, sqlite3_errmsg(db->sql));
}

enum dig_status dig_sql_run(const struct dig_db *const db, const char *const sql,
                            struct dig_error *const error)
{
    return sqlite3_exec(db->sql, sql, NULL, NULL, NULL) == SQLITE_OK ? DIG_OK
                                                                     : dig_sql_refuse(db, error);
}

enum dig_status dig_sql_prepare(const struct dig_db *const db, const char *const sql,
                                sqlite3_stmt **const s, struct dig_error *const error)
{
    return sqlite3_prepare_v2(db->sql, sql, -1, s, NULL) == SQLITE_OK ? DIG_OK
                                                                      : dig_sql_refuse(db, error);
}

enum dig_status dig_sql_first(const struct dig_db *const db, const char *const sql,
                              sqlite3_stmt **const s, struct dig_error *const error)
{
    if (sqlite3_prepare_v2(db->sql, sql, -1, s, NULL) == SQLITE_OK &&
        sqlite3_step(*s) == SQLITE_ROW) {
        return DIG_OK;
    }
    const enum dig_status status = dig_sql_refuse(db, error);
    (void)sqlite3_finalize(*s);
    *s = NULL;
    return status;
}

bool dig_sql_row(const struct dig_db *const db, sqlite3_stmt *const s,
                 enum dig_status *const status, struct dig_error *const error)
{
    const int step = *status == DIG_OK ? sqlite3_step(s) : SQLITE_DONE;
    if (step != SQLITE_ROW && step != SQLITE_DONE) {
        *status = dig_sql_refuse(db, error);
    }
    return step == SQLITE_ROW;
}

enum dig_status dig_sql_done(const struct dig_db *const db, sqlite3_stmt *const s,
                             struct dig_error *const error)
{
    const enum dig_status status =
        sqlite3_step(s) == SQLITE_DONE ? DIG_OK : dig_sql_refuse(db, error);
    (void)sqlite3_finalize(s);
    return status;
}

void dig_table_head_of(const struct dig_scene *const scene, struct dig_table_head *const head)
{
    *head = (struct dig_table_head){
        .tooth_m        = dig_scene_tooth_m(scene),
        .bucket_width_m = scene->bucket.width_m,
        .young_Pa       = scene->material.young_Pa,
        .smooth_half_s  = DIG_SMOOTH_HALF_s,
        .trajectories   = scene->trajectories,
    };
    memcpy(head->scene_name, scene->name, sizeof head->scene_name);
    memcpy(head->trajectory, scene->trajectory, sizeof head->trajectory);
    dig_scene_hash(scene, head->scene_hash);
}

static enum dig_status insert_scene(const struct dig_db *const    db,
                                    const struct dig_scene *const scene,
                                    struct dig_error *const       error)
{
    struct dig_table_head head;
    char                  text[DIG_SCENE_TEXT_SIZE];
    dig_scene_canonical(scene, text);
    dig_table_head_of(scene, &head);

    sqlite3_stmt         *s = NULL;
    const enum dig_status status =
        dig_sql_prepare(db, "INSERT INTO scene VALUES (1, ?, ?, ?, ?, ?, ?, ?, ?)", &s, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)sqlite3_bind_text(s, 1, head.scene_name, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(s, 2, head.scene_hash, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(s, 3, text, -1, SQLITE_STATIC);
    (void)sqlite3_bind_double(s, 4, head.tooth_m);
    (void)sqlite3_bind_double(s, 5, head.bucket_width_m);
    (void)sqlite3_bind_double(s, 6, head.young_Pa);
    (void)sqlite3_bind_double(s, 7, head.smooth_half_s);
    (void)sqlite3_bind_int(s, 8, DIG_CURVE_POINTS);
    return dig_sql_done(db, s, error);
}

static enum dig_status insert_trajectory(const struct dig_db *const db, const int id,
                                         const struct dig_trajectory *const t,
                                         struct dig_error *const            error)
{
    sqlite3_stmt   *s = NULL;
    enum dig_status status =
        dig_sql_prepare(db, "INSERT INTO trajectory VALUES (?, ?, ?, ?, ?)", &s, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)sqlite3_bind_int(s, 1, id);
    (void)sqlite3_bind_text(s, 2, t->name, -1, SQLITE_STATIC);
    (void)sqlite3_bind_double(s, 3, t->theta0_rad);
    (void)sqlite3_bind_double(s, 4, t->start_x_m);
    (void)sqlite3_bind_double(s, 5, t->start_z_m);
    status = dig_sql_done(db, s, error);
    for (size_t i = 0; status == DIG_OK && i < t->phases; i++) {
        const struct dig_phase *const p = &t->phase[i];
        status = dig_sql_prepare(db, "INSERT INTO phase VALUES (?, ?, ?, ?, ?, ?, ?)", &s, error);
        if (status != DIG_OK) {
            return status;
        }
        (void)sqlite3_bind_int(s, 1, id);
        (void)sqlite3_bind_int(s, 2, (int)i);
        (void)sqlite3_bind_text(s, 3, p->name, -1, SQLITE_STATIC);
        (void)sqlite3_bind_double(s, 4, p->duration_s);
        (void)sqlite3_bind_double(s, 5, p->vx_mps);
        (void)sqlite3_bind_double(s, 6, p->vz_mps);
        (void)sqlite3_bind_double(s, 7, p->omega_radps);
        status = dig_sql_done(db, s, error);
    }
    return status;
}

enum dig_status dig_schema_tables(const struct dig_db *const db, const int version,
                                  struct dig_error *const error)
{
    static const char ground_sql[] = DIG_GROUND_SQL("ground");
    enum dig_status   status       = dig_sql_run(db, common_sql, error);
    if (status == DIG_OK) {
        status = dig_sql_run(db, version == DIG_TABLE_VERSION_PLAIN ? plain_ground_sql : ground_sql,
                             error);
    }
    return status == DIG_OK && version >= DIG_TABLE_VERSION ? dig_sql_run(db, DIG_SEAL_SQL, error)
                                                            : status;
}

enum dig_status dig_schema_number(const struct dig_db *const db, struct dig_error *const error)
{
    char ids[128];
    (void)snprintf(ids, sizeof ids, "PRAGMA application_id = %d; PRAGMA user_version = %d;",
                   DIG_TABLE_APPLICATION_ID, DIG_TABLE_VERSION);
    return dig_sql_run(db, ids, error);
}

enum dig_status dig_schema_create(const struct dig_db *const    db,
                                  const struct dig_scene *const scene,
                                  struct dig_error *const       error)
{
    enum dig_status status = dig_sql_run(db, "BEGIN IMMEDIATE", error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_schema_tables(db, DIG_TABLE_VERSION, error);
    if (status == DIG_OK) {
        status = dig_schema_number(db, error);
    }
    if (status == DIG_OK) {
        status = insert_scene(db, scene, error);
    }
    for (size_t i = 0; status == DIG_OK && i < scene->trajectories; i++) {
        status = insert_trajectory(db, (int)i, &scene->trajectory[i], error);
    }
    if (status == DIG_OK) {
        status = dig_sql_run(db, "COMMIT", error);
    }
    if (status != DIG_OK) {
        (void)sqlite3_exec(db->sql, "ROLLBACK", NULL, NULL, NULL);
    }
    return status;
}
