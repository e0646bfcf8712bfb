#include "tables/schema/schema.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char tables_sql[] =
    "CREATE TABLE scene ("
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
    ") STRICT;"
    "CREATE TABLE ground ("
    "  id INTEGER PRIMARY KEY,"
    "  friction REAL NOT NULL,"
    "  rolling REAL NOT NULL,"
    "  density_kgpm3 REAL NOT NULL,"
    "  effect TEXT NOT NULL,"
    "  magnitude REAL NOT NULL CHECK (effect <> '' OR magnitude = 0),"
    "  depth REAL NOT NULL CHECK (depth > 0),"
    "  attack_rad REAL NOT NULL,"
    "  UNIQUE (friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad)"
    ") STRICT;"
    "CREATE TABLE seal ("
    "  ground INTEGER NOT NULL,"
    "  trajectory INTEGER NOT NULL,"
    "  sum INTEGER NOT NULL,"
    "  PRIMARY KEY (ground, trajectory),"
    "  FOREIGN KEY (ground, trajectory) REFERENCES entry (ground, trajectory)"
    ") STRICT;";

void dig_db_fail(struct dig_db *const db, const enum dig_status status, const char *const format,
                 ...)
{
    struct dig_error what;
    va_list          args;
    va_start(args, format);
    (void)vsnprintf(what.text, sizeof what.text, format, args);
    va_end(args);
    if (db->status == DIG_OK) {
        db->status = dig_error_set(db->error, status, "%s: %s", db->path, what.text);
    }
}

void dig_sql_refuse(struct dig_db *const db)
{
    const int code     = sqlite3_errcode(db->sql);
    const int extended = sqlite3_extended_errcode(db->sql);
    if (code == SQLITE_NOMEM) {
        dig_db_fail(db, DIG_ENOMEM, "no memory");
    } else if (code == SQLITE_NOTADB) {
        dig_db_fail(db, DIG_EINVAL, "not a digsight table, expected a file made by digtable");
    } else if (code == SQLITE_CORRUPT) {
        dig_db_fail(db, DIG_EINVAL, "damaged: %s, expected an intact table",
                    sqlite3_errmsg(db->sql));
    } else if (code == SQLITE_CANTOPEN || extended == SQLITE_IOERR_SHMOPEN ||
               extended == SQLITE_IOERR_SHMSIZE || extended == SQLITE_IOERR_SHMMAP) {
        dig_db_fail(db, DIG_EIO,
                    "it, or a journal beside it, cannot be opened, expected regular files and a "
                    "journal of this table alone");
    } else {
        dig_db_fail(db, DIG_EIO, "%s", sqlite3_errmsg(db->sql));
    }
}

void dig_sql_run(struct dig_db *const db, const char *const sql)
{
    if (db->status == DIG_OK && sqlite3_exec(db->sql, sql, NULL, NULL, NULL) != SQLITE_OK) {
        dig_sql_refuse(db);
    }
}

sqlite3_stmt *dig_sql_prepare(struct dig_db *const db, const char *const sql)
{
    sqlite3_stmt *s = NULL;
    if (db->status == DIG_OK && sqlite3_prepare_v2(db->sql, sql, -1, &s, NULL) != SQLITE_OK) {
        dig_sql_refuse(db);
    }
    return s;
}

sqlite3_stmt *dig_sql_first(struct dig_db *const db, const char *const sql)
{
    sqlite3_stmt *const s = dig_sql_prepare(db, sql);
    if (dig_sql_row(db, s)) {
        return s;
    }
    dig_sql_refuse(db);
    (void)sqlite3_finalize(s);
    return NULL;
}

bool dig_sql_row(struct dig_db *const db, sqlite3_stmt *const s)
{
    const int step = db->status == DIG_OK ? sqlite3_step(s) : SQLITE_DONE;
    if (step != SQLITE_ROW && step != SQLITE_DONE) {
        dig_sql_refuse(db);
    }
    return step == SQLITE_ROW;
}

void dig_sql_done(struct dig_db *const db, sqlite3_stmt *const s)
{
    if (db->status == DIG_OK && sqlite3_step(s) != SQLITE_DONE) {
        dig_sql_refuse(db);
    }
    (void)sqlite3_finalize(s);
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

static void insert_scene(struct dig_db *const db, const struct dig_scene *const scene)
{
    struct dig_table_head head;
    char                  text[DIG_SCENE_TEXT_SIZE];
    dig_scene_canonical(scene, text);
    dig_table_head_of(scene, &head);
    sqlite3_stmt *const s =
        dig_sql_prepare(db, "INSERT INTO scene VALUES (1, ?, ?, ?, ?, ?, ?, ?, ?)");
    (void)sqlite3_bind_text(s, 1, head.scene_name, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(s, 2, head.scene_hash, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(s, 3, text, -1, SQLITE_STATIC);
    (void)sqlite3_bind_double(s, 4, head.tooth_m);
    (void)sqlite3_bind_double(s, 5, head.bucket_width_m);
    (void)sqlite3_bind_double(s, 6, head.young_Pa);
    (void)sqlite3_bind_double(s, 7, head.smooth_half_s);
    (void)sqlite3_bind_int(s, 8, DIG_CURVE_POINTS);
    dig_sql_done(db, s);
}

static void insert_trajectory(struct dig_db *const db, const int id,
                              const struct dig_trajectory *const t)
{
    sqlite3_stmt *s = dig_sql_prepare(db, "INSERT INTO trajectory VALUES (?, ?, ?, ?, ?)");
    (void)sqlite3_bind_int(s, 1, id);
    (void)sqlite3_bind_text(s, 2, t->name, -1, SQLITE_STATIC);
    (void)sqlite3_bind_double(s, 3, t->theta0_rad);
    (void)sqlite3_bind_double(s, 4, t->start_x_m);
    (void)sqlite3_bind_double(s, 5, t->start_z_m);
    dig_sql_done(db, s);
    for (size_t i = 0; i < t->phases; i++) {
        const struct dig_phase *const p = &t->phase[i];
        s = dig_sql_prepare(db, "INSERT INTO phase VALUES (?, ?, ?, ?, ?, ?, ?)");
        (void)sqlite3_bind_int(s, 1, id);
        (void)sqlite3_bind_int(s, 2, (int)i);
        (void)sqlite3_bind_text(s, 3, p->name, -1, SQLITE_STATIC);
        (void)sqlite3_bind_double(s, 4, p->duration_s);
        (void)sqlite3_bind_double(s, 5, p->vx_mps);
        (void)sqlite3_bind_double(s, 6, p->vz_mps);
        (void)sqlite3_bind_double(s, 7, p->omega_radps);
        dig_sql_done(db, s);
    }
}

void dig_schema_tables(struct dig_db *const db)
{
    char ids[128];
    (void)snprintf(ids, sizeof ids, "PRAGMA application_id = %d; PRAGMA user_version = %d;",
                   DIG_TABLE_APPLICATION_ID, DIG_TABLE_VERSION);
    dig_sql_run(db, tables_sql);
    dig_sql_run(db, ids);
}

void dig_schema_create(struct dig_db *const db, const struct dig_scene *const scene)
{
    dig_sql_run(db, "BEGIN IMMEDIATE");
    dig_schema_tables(db);
    insert_scene(db, scene);
    for (size_t i = 0; i < scene->trajectories; i++) {
        insert_trajectory(db, (int)i, &scene->trajectory[i]);
    }
    dig_sql_run(db, "COMMIT");
    if (db->status != DIG_OK) {
        (void)sqlite3_exec(db->sql, "ROLLBACK", NULL, NULL, NULL);
    }
}
