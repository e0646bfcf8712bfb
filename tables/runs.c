// Reads runs, and derives entries from them: the half of the store that reads rows.

#include "core/name.h"
#include "tables/store.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void dig_ground_bind(sqlite3_stmt *const s, const struct dig_run_origin *const origin)
{
    for (int a = 0; a < DIG_AXES; a++) {
        (void)sqlite3_bind_double(s, a + 1, origin->gravel.value[a]);
    }
    (void)sqlite3_bind_text(s, DIG_AXES + 1, origin->effect, -1, SQLITE_STATIC);
    (void)sqlite3_bind_double(s, DIG_AXES + 2, origin->magnitude);
    const struct dig_approach normalized = dig_approach_normalized(&origin->approach);
    (void)sqlite3_bind_double(s, DIG_AXES + 3, normalized.depth);
    (void)sqlite3_bind_double(s, DIG_AXES + 4, normalized.attack_rad);
}

enum dig_status dig_store_has(struct dig_store *const            store,
                              const struct dig_run_origin *const origin, bool *const there,
                              struct dig_error *const error)
{
    assert(store != NULL && origin != NULL && there != NULL);
    struct dig_db *const db = dig_store_ask(store, error);
    sqlite3_stmt *const  s  = dig_sql_prepare(
          db, "SELECT 1 FROM run JOIN ground g ON g.id = run.ground WHERE friction = ?1 "
                "AND rolling = ?2 AND density_kgpm3 = ?3 AND effect = ?4 AND magnitude = ?5 "
                "AND depth = ?6 AND attack_rad = ?7 AND packing = ?8 AND trajectory = ?9");
    dig_ground_bind(s, origin);
    (void)sqlite3_bind_int64(s, 8, (sqlite3_int64)origin->packing);
    (void)sqlite3_bind_int64(s, 9, (sqlite3_int64)origin->trajectory);
    const bool found = dig_sql_row(db, s);
    if (db->status == DIG_OK) {
        *there = found;
    }
    (void)sqlite3_finalize(s);
    return db->status;
}

// Copies a text column, cut to fit: provenance is for people. False when it holds what no label
// may, which an export would take for a field's end.
static bool column_label(sqlite3_stmt *const s, const int column, const size_t size,
                         char text[const])
{
    const char *const found = (const char *)sqlite3_column_text(s, column);
    (void)snprintf(text, size, "%s", found != NULL ? found : "");
    return text[0] == '\0' || dig_label_ok(found);
}

#define RUN_COLUMNS                                                                                \
    "friction, rolling, density_kgpm3, packing, trajectory, seed, engine, version, grains, "       \
    "wall_s, made_utc, windows, first_s, step_s, curve, effect, magnitude, depth, attack_rad"

// The row a statement over RUN_COLUMNS stands on. Returns run->value, malloc'ed; NULL where it
// fails.
static float *read_run(struct dig_db *const db, const struct dig_table_head *const head,
                       sqlite3_stmt *const s, struct dig_run *const run)
{
    struct dig_run_origin *const o = &run->origin;
    for (int a = 0; a < DIG_AXES; a++) {
        o->gravel.value[a] = sqlite3_column_double(s, a);
    }
    const sqlite3_int64 packing    = sqlite3_column_int64(s, 3);
    const sqlite3_int64 trajectory = sqlite3_column_int64(s, 4);
    const sqlite3_int64 windows    = sqlite3_column_int64(s, 11);
    o->packing                     = (size_t)packing;
    o->trajectory                  = (size_t)trajectory;
    o->seed                        = (uint64_t)sqlite3_column_int64(s, 5);
    bool labels                    = column_label(s, 6, sizeof o->engine, o->engine);
    labels                         = column_label(s, 7, sizeof o->version, o->version) && labels;
    labels                         = column_label(s, 10, sizeof o->made_utc, o->made_utc) && labels;
    labels                         = column_label(s, 15, sizeof o->effect, o->effect) && labels;
    o->grains                      = (size_t)sqlite3_column_int64(s, 8);
    o->wall_s                      = sqlite3_column_double(s, 9);
    o->magnitude                   = sqlite3_column_double(s, 16);
    o->approach =
        (struct dig_approach){ sqlite3_column_double(s, 17), sqlite3_column_double(s, 18) };
    run->first_s = sqlite3_column_double(s, 12);
    run->step_s  = sqlite3_column_double(s, 13);
    if (!labels) {
        dig_db_fail(db, DIG_EINVAL,
                    "run: engine \"%s\", version \"%s\", made_utc \"%s\", expected " DIG_LABEL_RULE,
                    o->engine, o->version, o->made_utc);
        return NULL;
    }
    const uint8_t *const bytes = sqlite3_column_blob(s, 14);
    const int            size  = sqlite3_column_bytes(s, 14);
    if (packing < 0 || trajectory < 0 || trajectory >= (sqlite3_int64)head->trajectories ||
        windows < 2 || windows > DIG_WINDOWS_MAX || size != (int)windows * DIG_CHANNELS * 4 ||
        !(run->step_s > 0.0) || !isfinite(run->step_s) || !isfinite(run->first_s)) {
        dig_db_fail(db, DIG_EINVAL,
                    "run.curve: %d bytes for %lld windows from %g s by %g s, expected %d each at "
                    "finite times",
                    size, (long long)windows, run->first_s, run->step_s, DIG_CHANNELS * 4);
        return NULL;
    }
    run->windows      = (size_t)windows;
    float *const into = malloc(run->windows * DIG_CHANNELS * sizeof *into);
    if (into == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory");
        return NULL;
    }
    dig_floats_unpack(run->windows * DIG_CHANNELS, bytes, into);
    if (!dig_channels_sound(run->windows, into)) {
        dig_db_fail(db, DIG_EINVAL, "run.curve: a number that is not finite, expected finite ones");
    }
    run->value = into;
    return into;
}

void dig_sql_walk(struct dig_db *const db, const struct dig_table_head *const head,
                  const char *const which, const struct dig_run_visitor *const visitor)
{
    char      sql[500];
    const int length =
        snprintf(sql, sizeof sql,
                 "SELECT " RUN_COLUMNS " FROM run JOIN ground g ON g.id = run.ground %s", which);
    assert(length > 0 && (size_t)length < sizeof sql);
    (void)length;
    sqlite3_stmt *const s = dig_sql_prepare(db, sql);
    while (dig_sql_row(db, s)) {
        struct dig_run run   = { .windows = 0 };
        float *const   value = read_run(db, head, s, &run);
        if (db->status == DIG_OK) {
            db->status = visitor->visit(visitor->context, &run, db->error);
        }
        free(value);
    }
    (void)sqlite3_finalize(s);
}

enum dig_status dig_store_walk(struct dig_store *const             store,
                               const struct dig_run_visitor *const visitor,
                               struct dig_error *const             error)
{
    assert(store != NULL && visitor != NULL);
    dig_sql_walk(dig_store_ask(store, error), &store->head,
                 "ORDER BY friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad, "
                 "trajectory, packing",
                 visitor);
    return store->db.status;
}

struct deriving {
    const struct dig_store *store;
    struct dig_ensemble    *ensemble;
};

static enum dig_status derive_one(void *const context, const struct dig_run *const run,
                                  struct dig_error *const error)
{
    const struct deriving *const       d    = context;
    const struct dig_table_head *const head = &d->store->head;
    const size_t                       t    = run->origin.trajectory;
    struct dig_trajectory              dug; // progress is a share of its path, not of the plain one
    double                             curve[DIG_CHANNELS][DIG_CURVE_POINTS];
    struct dig_error                   why    = { "" };
    enum dig_status                    status = dig_approach_apply(
                           &head->trajectory[t], head->tooth_m, head->depth_m[t], &run->origin.approach, &dug, &why);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: run: %s", d->store->path, why.text);
    }
    status = dig_derive_run(&dug, head->tooth_m, head->smooth_half_s, run->windows, run->first_s,
                            run->step_s, run->value, curve);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: no memory", d->store->path);
    }
    dig_ensemble_add(d->ensemble, (const double(*)[DIG_CURVE_POINTS])curve);
    return DIG_OK;
}

void dig_entry_derive(struct dig_store *const store, const sqlite3_int64 ground,
                      const size_t trajectory, struct dig_ensemble *const ensemble)
{
    char                         which[120];
    struct deriving              deriving = { store, ensemble };
    const struct dig_run_visitor visitor  = { derive_one, &deriving };
    *ensemble                             = (struct dig_ensemble){ 0 };
    (void)snprintf(which, sizeof which, "WHERE ground = %lld AND trajectory = %zu ORDER BY packing",
                   (long long)ground, trajectory);
    dig_sql_walk(&store->db, &store->head, which, &visitor);
}
