// What the tests of tables share: a small scene, and digs whose ensembles are known by hand.

#ifndef DIG_TESTS_TABLES_FIXTURE_H
#define DIG_TESTS_TABLES_FIXTURE_H

#include "core/recording.h"
#include "core/scene.h"
#include "tables/load.h"
#include "tables/store.h"
#include "tests/scratch.h"
#include "tests/seal_all.h"

#include <sqlite3.h>

/// "pull" has one speed, so that progress is time over duration; the second half of "push" is three
/// times as fast as the first, so that a quarter of its path is done in half of its time.
static inline struct dig_scene fixture_scene(void)
{
    return (struct dig_scene){
        .name         = "tub",
        .bucket       = { 3, { 0.0, -0.04, 0.0 }, { -0.09, -0.04, 0.0 }, 0.07 },
        .box          = { 0.0, 0.3, -0.06, 0.06, 0.0, 0.085 },
        .packing      = { 0.3, 0.7, 0.3, 0.45, 0.15 },
        .material     = { 0.0075, 5e6, 0.2, 0.2, 2.0 },
        .gravity_mps2 = 9.81,
        .output_s     = 0.005,
        .trajectories = 2,
        .trajectory   = { { "pull", 0.0, 0.1, 0.2, 1, { { "pull", 2.0, 0.05, 0.0, 0.0 } } },
                          { "push",
                            0.1,
                            0.2,
                            0.2,
                            2,
                            { { "one", 0.5, -0.05, 0.0, 0.0 }, { "two", 0.5, -0.15, 0.0, 0.0 } } } },
    };
}

/// The same, but "pull" goes into the ground, as fast: it can be dug deeper.
static inline struct dig_scene fixture_diving_scene(void)
{
    struct dig_scene scene              = fixture_scene();
    scene.trajectory[0].phase[0].vx_mps = 0.04;
    scene.trajectory[0].phase[0].vz_mps = -0.03;
    return scene;
}

/// A dig of `rows` windows of 5 ms with the moment my + slope t, Fx = 2 My, Fz = -3 My, and 5 My of
/// carried mass. The array
/// is static: one recording at a time.
static inline struct dig_recording fixture_ramp(const size_t rows, const double my_Nm,
                                                const double slope_Nmps)
{
    static struct dig_force_row row[1000];
    assert_true(rows <= 1000);
    for (size_t i = 0; i < rows; i++) {
        const double t_s = 0.0025 + 0.005 * (double)i;
        const double at  = my_Nm + slope_Nmps * t_s;
        row[i]           = (struct dig_force_row){
                      .t_s = t_s, .Fx_N = 2 * at, .Fz_N = -3 * at, .My_Nm = at, .carried_kg = 5 * at
        };
    }
    return (struct dig_recording){ .rows = rows, .row = row };
}

static inline struct dig_recording fixture_recording(const size_t rows, const double my_Nm)
{
    return fixture_ramp(rows, my_Nm, 0.0);
}

static inline struct dig_run_origin fixture_origin(const double friction, const double rolling,
                                                   const double density_kgpm3, const size_t packing,
                                                   const size_t trajectory)
{
    return (struct dig_run_origin){
        .gravel     = { { friction, rolling, density_kgpm3 } },
        .packing    = packing,
        .trajectory = trajectory,
        .seed       = 4611686018427387905U + packing,
        .engine     = "test",
        .version    = "1.2",
        .grains     = 12,
        .wall_s     = 0.5,
        .made_utc   = "2026-01-01T00:00:00Z",
    };
}

static inline struct dig_store *fixture_create_of(const char *const             name,
                                                  const struct dig_scene *const scene)
{
    struct dig_store *store = NULL;
    struct dig_error  error = { "" };
    assert_ok(dig_store_create(scratch_path(name), scene, &store, &error), error);
    return store;
}

static inline struct dig_store *fixture_create(const char *const name)
{
    const struct dig_scene scene = fixture_scene();
    return fixture_create_of(name, &scene);
}

/// fixture_origin() with an effect.
static inline struct dig_run_origin fixture_varied(struct dig_run_origin origin,
                                                   const char *const effect, const double magnitude)
{
    (void)snprintf(origin.effect, sizeof origin.effect, "%s", effect);
    origin.magnitude = magnitude;
    return origin;
}

/// Stores a dig of that origin with one moment all along.
static inline void fixture_put_run(struct dig_store *const     store,
                                   const struct dig_run_origin origin, const double my_Nm)
{
    const struct dig_recording recording =
        fixture_recording(origin.trajectory == 0 ? 400 : 200, my_Nm);
    struct dig_error error = { "" };
    assert_ok(dig_store_put(store, &origin, &recording, &error), error);
}

static inline void fixture_put(struct dig_store *const store, const double friction,
                               const double rolling, const size_t packing, const size_t trajectory,
                               const double my_Nm)
{
    fixture_put_run(store, fixture_origin(friction, rolling, 2500.0, packing, trajectory), my_Nm);
}

/// The table of that name, loaded.
static inline struct dig_curve_set *fixture_load(const char *const name)
{
    struct dig_curve_set *set   = NULL;
    struct dig_error      error = { "" };
    assert_ok(dig_table_load(scratch_path(name), &set, &error), error);
    return set;
}

/// The first number SQL finds in a table.
static inline sqlite3_int64 fixture_ask(const char *const name, const char *const sql)
{
    sqlite3      *db = NULL;
    sqlite3_stmt *s  = NULL;
    assert_int_equal(sqlite3_open(scratch_path(name), &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &s, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_ROW);
    const sqlite3_int64 answer = sqlite3_column_int64(s, 0);
    (void)sqlite3_finalize(s);
    (void)sqlite3_close(db);
    return answer;
}

static inline void fixture_run_sql(const char *const name, const char *const sql)
{
    sqlite3 *db    = NULL;
    char    *error = NULL;
    assert_int_equal(sqlite3_open(scratch_path(name), &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &error) != SQLITE_OK) {
        fail_msg("%s: %s", sql, error);
    }
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

/// A copy of a table under another name, changed by SQL.
static inline const char *fixture_copy(const char *const from, const char *const to,
                                       const char *const sql)
{
    size_t      size  = 0;
    char *const whole = scratch_read(scratch_path(from), &size);
    (void)scratch_write_bytes(to, whole, size);
    free(whole);
    fixture_run_sql(to, sql);
    return scratch_path(to);
}

/// The same, sealed after it was changed: what seals do not keep out.
static inline const char *fixture_copy_sealed(const char *const from, const char *const to,
                                              const char *const sql)
{
    const char *const path = fixture_copy(from, to, "DELETE FROM seal");
    fixture_run_sql(to, sql);
    seal_all(path);
    return path;
}

#endif // DIG_TESTS_TABLES_FIXTURE_H
