// Stores a run and the entry it changes: the half of the store that writes rows.

#include "core/effect.h"
#include "core/name.h"
#include "tables/schema/seal.h"
#include "tables/store.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static void check_origin(const struct dig_run_origin *const o, struct dig_conditions *const c)
{
    const bool plain = o->effect[0] == '\0';
    dig_require(c, plain || dig_effect_find(o->effect) >= 0,
                "run: effect \"%s\", expected one with a name", o->effect);
    dig_require(c, isfinite(o->magnitude) && (!plain || fabs(o->magnitude) <= 0.0),
                "run: magnitude %g of effect \"%s\", expected %s", o->magnitude, o->effect,
                plain ? "0" : "a finite one");
    dig_require(c,
                dig_label_ok(o->engine) && dig_label_ok(o->version) &&
                    (o->made_utc[0] == '\0' || dig_label_ok(o->made_utc)),
                "run: engine \"%s\", version \"%s\", made \"%s\", expected " DIG_LABEL_RULE,
                o->engine, o->version, o->made_utc);
    const struct dig_approach made = dig_approach_normalized(&o->approach);
    dig_require(c,
                made.depth >= DIG_APPROACH_DEPTH_LEAST && made.depth <= DIG_APPROACH_DEPTH_MOST &&
                    fabs(made.attack_rad) <= DIG_APPROACH_ATTACK_MOST_rad * (1.0 + 1e-12),
                "run: depth %g, attack %g rad, expected %g to %g and at most %g", made.depth,
                made.attack_rad, DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST,
                DIG_APPROACH_ATTACK_MOST_rad);
}

static void check_recording(const struct dig_recording *const r, const double step_s,
                            struct dig_conditions *const c)
{
    for (size_t i = 0; i < r->rows; i++) {
        const struct dig_force_row *const row   = &r->row[i];
        const double                      off_s = row->t_s - (r->row[0].t_s + (double)i * step_s);
        dig_require(c, step_s > 0.0 && fabs(off_s) <= 0.01 * step_s,
                    "recording: row %zu: t_s %.9g, expected evenly spaced times", i + 1, row->t_s);
        dig_require(c, isfinite(row->My_Nm) && isfinite(row->Fx_N) && isfinite(row->Fz_N),
                    "recording: row %zu: expected finite forces and moment", i + 1);
    }
}

// The samples as they are stored, little endian, malloc'ed; NULL without memory.
static uint8_t *pack_recording(const struct dig_recording *const r)
{
    float *const   value   = malloc(DIG_CHANNELS * r->rows * sizeof *value);
    uint8_t *const packed  = malloc(DIG_CHANNELS * r->rows * 4);
    const bool     carried = dig_recording_knows_carried(r);
    if (value != NULL && packed != NULL) {
        for (size_t i = 0; i < r->rows; i++) {
            value[DIG_CHANNEL_MY_Nm * r->rows + i] = (float)r->row[i].My_Nm;
            value[DIG_CHANNEL_FX_N * r->rows + i]  = (float)r->row[i].Fx_N;
            value[DIG_CHANNEL_FZ_N * r->rows + i]  = (float)r->row[i].Fz_N;
            value[DIG_CHANNEL_CARRIED_kg * r->rows + i] =
                carried ? (float)r->row[i].carried_kg : (float)NAN;
        }
        dig_floats_pack(DIG_CHANNELS * r->rows, value, packed);
        free(value);
        return packed;
    }
    free(value);
    free(packed);
    return NULL;
}

// Makes the ground's row where there is none yet, and finds its key.
static sqlite3_int64 make_ground(struct dig_db *const db, const struct dig_run *const run)
{
    sqlite3_stmt *const s = dig_sql_prepare(
        db, "INSERT INTO ground (" DIG_GROUND_COLUMNS ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7) "
            "ON CONFLICT DO UPDATE SET friction = friction RETURNING id");
    dig_run_bind(s, 1, DIG_RUN_FRICTION, DIG_RUN_TRAJECTORY, run);
    const sqlite3_int64 id = dig_sql_row(db, s) ? sqlite3_column_int64(s, 0) : 0;
    (void)sqlite3_finalize(s);
    return id;
}

static void insert_run(struct dig_store *const store, const sqlite3_int64 ground,
                       const struct dig_run *const run, const uint8_t *const bytes)
{
    enum { TRAJECTORY = 2 }; // its parameter; the others follow
    struct dig_db *const db = &store->db;
    sqlite3_stmt *const  s =
        dig_sql_prepare(db, "INSERT INTO run (ground, trajectory, packing, " DIG_MADE_COLUMNS ") "
                            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    (void)sqlite3_bind_int64(s, 1, ground);
    dig_run_bind(s, TRAJECTORY, DIG_RUN_TRAJECTORY, DIG_RUN_COLUMNS, run);
    (void)sqlite3_bind_blob64(s, TRAJECTORY + DIG_RUN_CURVE - DIG_RUN_TRAJECTORY, bytes,
                              DIG_CHANNELS * run->windows * 4, SQLITE_STATIC);
    const int step = db->status == DIG_OK ? sqlite3_step(s) : SQLITE_DONE;
    if (step == SQLITE_CONSTRAINT &&
        sqlite3_extended_errcode(db->sql) == SQLITE_CONSTRAINT_UNIQUE) {
        char text[DIG_RUN_TEXT_SIZE];
        dig_run_text(store, &run->origin, text);
        dig_db_fail(db, DIG_EINVAL, "run: packing %zu of %s is there already, expected a new one",
                    run->origin.packing, text);
    } else if (step != SQLITE_DONE) {
        dig_sql_refuse(db);
    }
    (void)sqlite3_finalize(s);
}

static void write_entry(struct dig_db *const db, const sqlite3_int64 ground,
                        const size_t trajectory, const struct dig_ensemble *const e)
{
    enum { NUMBERS = DIG_CHANNELS * DIG_CURVE_POINTS };
    struct dig_curve curve;
    uint8_t          mean[NUMBERS * 4];
    uint8_t          spread[NUMBERS * 4];
    dig_ensemble_curve(e, &curve);
    dig_floats_pack(NUMBERS, &curve.mean[0][0], mean);
    dig_floats_pack(NUMBERS, &curve.sd[0][0], spread);
    sqlite3_stmt *const s =
        dig_sql_prepare(db, "INSERT INTO entry (ground, trajectory, packings, mean, spread) "
                            "VALUES (?1, ?2, ?3, ?4, ?5) ON CONFLICT (ground, trajectory) DO "
                            "UPDATE SET packings = ?3, mean = ?4, spread = ?5");
    (void)sqlite3_bind_int64(s, 1, ground);
    (void)sqlite3_bind_int64(s, 2, (sqlite3_int64)trajectory);
    (void)sqlite3_bind_int64(s, 3, (sqlite3_int64)e->packings);
    (void)sqlite3_bind_blob(s, 4, mean, sizeof mean, SQLITE_STATIC);
    if (e->packings > 1) {
        (void)sqlite3_bind_blob(s, 5, spread, sizeof spread, SQLITE_STATIC);
    }
    dig_sql_done(db, s);
}

void dig_entry_refresh(struct dig_store *const store, const sqlite3_int64 ground,
                       const size_t trajectory)
{
    struct dig_ensemble *const ensemble = calloc(1, sizeof *ensemble);
    if (ensemble == NULL) {
        dig_db_fail(&store->db, DIG_ENOMEM, "no memory");
        return;
    }
    dig_entry_derive(store, ground, trajectory, ensemble);
    write_entry(&store->db, ground, trajectory, ensemble);
    dig_seal_write(&store->db, ground, trajectory);
    free(ensemble);
}

enum dig_status dig_store_begin(struct dig_store *const store, struct dig_error *const error)
{
    assert(store != NULL && store->lock_fd >= 0 && !store->gathers);
    struct dig_db *const db = dig_store_ask(store, error);
    dig_sql_run(db, "BEGIN IMMEDIATE");
    store->gathers = db->status == DIG_OK;
    return db->status;
}

enum dig_status dig_store_commit(struct dig_store *const store, struct dig_error *const error)
{
    assert(store != NULL && store->gathers);
    struct dig_db *const db = dig_store_ask(store, error);
    dig_sql_run(db, "COMMIT");
    store->gathers = db->status != DIG_OK;
    return db->status;
}

// All of it or, where the database has failed, nothing.
static void put_run(struct dig_store *const store, const struct dig_run *const run,
                    const uint8_t *const bytes)
{
    struct dig_db *const db = &store->db;
    dig_sql_run(db, store->gathers ? "SAVEPOINT run" : "BEGIN IMMEDIATE");
    if (db->status != DIG_OK) {
        return;
    }
    const sqlite3_int64 ground = make_ground(db, run);
    insert_run(store, ground, run, bytes);
    dig_entry_refresh(store, ground, run->origin.trajectory);
    dig_sql_run(db, store->gathers ? "RELEASE run" : "COMMIT");
    if (db->status != DIG_OK) {
        (void)sqlite3_exec(db->sql, store->gathers ? "ROLLBACK TO run; RELEASE run" : "ROLLBACK",
                           NULL, NULL, NULL);
    }
}

enum dig_status dig_store_put(struct dig_store *const            store,
                              const struct dig_run_origin *const origin,
                              const struct dig_recording *const  recording,
                              struct dig_error *const            error)
{
    assert(store != NULL && origin != NULL && recording != NULL);
    assert(store->lock_fd >= 0 && origin->trajectory < store->head.trajectories);
    const size_t rows = recording->rows;
    if (rows < 2 || rows > DIG_WINDOWS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "recording: %zu rows, expected 2 to %d", rows,
                             DIG_WINDOWS_MAX);
    }
    const double step_s =
        (recording->row[rows - 1].t_s - recording->row[0].t_s) / (double)(rows - 1);
    struct dig_conditions c = { .error = error };
    check_origin(origin, &c);
    check_recording(recording, step_s, &c);
    if (c.status != DIG_OK) {
        return c.status;
    }
    struct dig_db *const db    = dig_store_ask(store, error);
    uint8_t *const       bytes = pack_recording(recording);
    if (bytes == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for %zu rows", rows);
    } else {
        struct dig_run run  = { *origin, rows, recording->row[0].t_s, step_s, NULL };
        run.origin.approach = dig_approach_normalized(&origin->approach);
        put_run(store, &run, bytes);
    }
    free(bytes);
    return db->status;
}
