// Reads runs, and derives entries from them: the half of the store that reads rows.

#include "core/name.h"
#include "tables/store.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

// How a column stands in a struct dig_run.
// clang-format off
#define COLUMN(kind, field) { kind, offsetof(struct dig_run, field), sizeof((struct dig_run *)0)->field }
static const struct {
    enum { REAL, COUNT, SEED, TEXT, CURVE } kind;
    size_t at, size;
} columns[DIG_RUN_COLUMNS] = {
    COLUMN(REAL, origin.gravel.value[0]), COLUMN(REAL, origin.gravel.value[1]),
    COLUMN(REAL, origin.gravel.value[2]), COLUMN(TEXT, origin.effect), COLUMN(REAL, origin.magnitude),
    COLUMN(REAL, origin.approach.depth), COLUMN(REAL, origin.approach.attack_rad),
    COLUMN(COUNT, origin.trajectory), COLUMN(COUNT, origin.packing), COLUMN(SEED, origin.seed),
    COLUMN(TEXT, origin.engine), COLUMN(TEXT, origin.version), COLUMN(COUNT, origin.grains),
    COLUMN(COUNT, windows), COLUMN(REAL, first_s), COLUMN(REAL, step_s), COLUMN(CURVE, value),
    COLUMN(TEXT, origin.made_utc), COLUMN(REAL, origin.wall_s),
};
// clang-format on

void dig_run_bind(sqlite3_stmt *const s, const int parameter, const enum dig_run_column first,
                  const enum dig_run_column end, const struct dig_run *const run)
{
    for (int c = (int)first; c < (int)end; c++) {
        const void *const field = (const char *)run + columns[c].at;
        const int         to    = parameter + c - (int)first;
        switch (columns[c].kind) {
        case REAL: (void)sqlite3_bind_double(s, to, *(const double *)field); break;
        case COUNT: (void)sqlite3_bind_int64(s, to, (sqlite3_int64) * (const size_t *)field); break;
        case SEED:
            (void)sqlite3_bind_int64(s, to, (sqlite3_int64) * (const uint64_t *)field);
            break;
        case TEXT: (void)sqlite3_bind_text(s, to, field, -1, SQLITE_STATIC); break;
        case CURVE: break;
        }
    }
}

enum dig_status dig_store_has(struct dig_store *const            store,
                              const struct dig_run_origin *const origin, bool *const there,
                              struct dig_error *const error)
{
    assert(store != NULL && origin != NULL && there != NULL);
    struct dig_db *const db  = dig_store_ask(store, error);
    struct dig_run       key = { .origin = *origin };
    key.origin.approach      = dig_approach_normalized(&origin->approach);
    sqlite3_stmt *const s =
        dig_sql_prepare(db, "SELECT 1 FROM run JOIN ground g ON g.id = run.ground WHERE "
                            "(" DIG_KEY_COLUMNS ") = (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
    dig_run_bind(s, 1, DIG_RUN_FRICTION, DIG_RUN_SEED, &key);
    const bool found = dig_sql_row(db, s);
    if (db->status == DIG_OK) {
        *there = found;
    }
    (void)sqlite3_finalize(s);
    return db->status;
}

bool dig_run_read(sqlite3_stmt *const s, const enum dig_run_column end, struct dig_run *const run)
{
    bool        labels = true;
    const char *text   = NULL;
    for (int c = 0; c < (int)end; c++) {
        void *const field = (char *)run + columns[c].at;
        switch (columns[c].kind) {
        case REAL: *(double *)field = sqlite3_column_double(s, c); break;
        case COUNT: *(size_t *)field = (size_t)sqlite3_column_int64(s, c); break;
        case SEED: *(uint64_t *)field = (uint64_t)sqlite3_column_int64(s, c); break;
        case TEXT:
            // Cut to fit: provenance is for people. What no label may hold, an export would take
            // for a field's end.
            text = (const char *)sqlite3_column_text(s, c);
            (void)snprintf(field, columns[c].size, "%s", text != NULL ? text : "");
            labels = labels && (text == NULL || text[0] == '\0' || dig_label_ok(text));
            break;
        case CURVE: break;
        }
    }
    return labels;
}

void dig_run_text(const struct dig_store *const store, const struct dig_run_origin *const origin,
                  char text[const DIG_RUN_TEXT_SIZE])
{
    const struct dig_table_head *const head = &store->head;
    const double *const                v    = origin->gravel.value;
    char                               how[DIG_APPROACH_TEXT_SIZE];
    dig_approach_text(&origin->approach, how);
    (void)snprintf(
        text, DIG_RUN_TEXT_SIZE, "friction %g, rolling %g, %g kg/m3%s%s on %s%s", v[0], v[1], v[2],
        origin->effect[0] != '\0' ? " with " : "", origin->effect,
        origin->trajectory < head->trajectories ? head->trajectory[origin->trajectory].name : "?",
        how);
}

// The row a statement over DIG_KEY_COLUMNS and DIG_MADE_COLUMNS stands on. Returns run->value,
// malloc'ed; NULL where it fails.
static float *read_run(struct dig_db *const db, const struct dig_table_head *const head,
                       sqlite3_stmt *const s, struct dig_run *const run)
{
    const struct dig_run_origin *const o          = &run->origin;
    const bool                         labels     = dig_run_read(s, DIG_RUN_COLUMNS, run);
    const sqlite3_int64                packing    = (sqlite3_int64)o->packing;
    const sqlite3_int64                trajectory = (sqlite3_int64)o->trajectory;
    const sqlite3_int64                windows    = (sqlite3_int64)run->windows;
    if (!labels) {
        dig_db_fail(db, DIG_EINVAL,
                    "run: engine \"%s\", version \"%s\", made_utc \"%s\", expected " DIG_LABEL_RULE,
                    o->engine, o->version, o->made_utc);
        return NULL;
    }
    const uint8_t *const bytes = sqlite3_column_blob(s, DIG_RUN_CURVE);
    const int            size  = sqlite3_column_bytes(s, DIG_RUN_CURVE);
    if (packing < 0 || trajectory < 0 || trajectory >= (sqlite3_int64)head->trajectories ||
        windows < 2 || windows > DIG_WINDOWS_MAX || size != (int)windows * DIG_CHANNELS * 4 ||
        !(run->step_s > 0.0) || !isfinite(run->step_s) || !isfinite(run->first_s)) {
        dig_db_fail(db, DIG_EINVAL,
                    "run.curve: %d bytes for %lld windows from %g s by %g s, expected %d each at "
                    "finite times",
                    size, (long long)windows, run->first_s, run->step_s, DIG_CHANNELS * 4);
        return NULL;
    }
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
    const int length = snprintf(sql, sizeof sql,
                                "SELECT " DIG_KEY_COLUMNS ", " DIG_MADE_COLUMNS
                                " FROM run JOIN ground g ON g.id = run.ground %s",
                                which);
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
    dig_sql_walk(dig_store_ask(store, error), &store->head, "ORDER BY " DIG_KEY_COLUMNS, visitor);
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
