// The store's struct, shared by the files of tables/.

#ifndef DIG_TABLES_STORE_PRIVATE_H
#define DIG_TABLES_STORE_PRIVATE_H

#include "tables/derive.h"
#include "tables/schema/schema.h"
#include "tables/store.h"

#include <limits.h>

#define DIG_WINDOWS_MAX 1000000 // of one dig; a blob beyond it is damage

struct dig_store {
    struct dig_db         db;
    int                   lock_fd; // -1: opened to read
    bool                  gathers; // between dig_store_begin() and dig_store_commit()
    struct dig_table_head head;
    char                  path[PATH_MAX];
};

/// What is asked of the store next may fail anew, and says so in *error. Returns its database.
static inline struct dig_db *dig_store_ask(struct dig_store *const store,
                                           struct dig_error *const error)
{
    store->db.status = DIG_OK;
    store->db.error  = error;
    return &store->db;
}

/// Opens the file read-only, rolling back first what a crash left half written, begins a
/// transaction and checks the file in it. Close its sql, also where that failed.
struct dig_db dig_sql_open_read(const char *path, struct dig_table_head *head,
                                struct dig_error *error);

/// What was dug without an effect, from an open database, which should be in a transaction; there
/// may be no entries. Where one has a single packing, its spread is pooled from all of them that
/// have more. NULL where the database has failed.
struct dig_curve_set *dig_sql_load(struct dig_db *db, const struct dig_table_head *head);

/// Fills set->covariance from all runs without an effect, as the trajectories stand. Of a gravel
/// that was dug once nothing is learnt. Reads every such run: 0.1 ms each. DIG_EINVAL: a run that
/// cannot be one. Call it in a transaction.
void dig_sql_load_covariance(struct dig_db *db, const struct dig_table_head *head,
                             struct dig_curve_set *set);

/// The columns of a run, with its ground's, in the order of enum dig_run_column.
#define DIG_GROUND_COLUMNS "friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad"
#define DIG_KEY_COLUMNS    DIG_GROUND_COLUMNS ", trajectory, packing"
#define DIG_MADE_COLUMNS                                                                           \
    "seed, engine, version, grains, windows, first_s, step_s, curve, made_utc, wall_s"

enum dig_run_column {
    DIG_RUN_FRICTION,
    DIG_RUN_TRAJECTORY = 7, // before it the ground
    DIG_RUN_SEED       = 9, // before it the key
    DIG_RUN_CURVE      = 16,
    DIG_RUN_COLUMNS    = 19
};

/// Binds these columns of a run to parameters of a statement, from `parameter` on. Its curve is not
/// bound, and the run must outlive that.
void dig_run_bind(sqlite3_stmt *s, int parameter, enum dig_run_column first,
                  enum dig_run_column end, const struct dig_run *run);

/// Reads the columns before `end` from the row a statement over them stands on, but not the curve.
/// False where a text is no label.
bool dig_run_read(sqlite3_stmt *s, enum dig_run_column end, struct dig_run *run);

/// "friction 0.5, rolling 0.5, 2500 kg/m3 with cohesion on simpleA, depth 1.2, attack 0 deg".
#define DIG_RUN_TEXT_SIZE 256
void dig_run_text(const struct dig_store *store, const struct dig_run_origin *origin,
                  char text[DIG_RUN_TEXT_SIZE]);

/// Visits the runs that `which`, the end of a statement over `run` and `ground`, says.
void dig_sql_walk(struct dig_db *db, const struct dig_table_head *head, const char *which,
                  const struct dig_run_visitor *visitor);

/// The mean and spread of all runs of one ground and trajectory, added up by packing.
void dig_entry_derive(struct dig_store *store, sqlite3_int64 ground, size_t trajectory,
                      struct dig_ensemble *ensemble);

/// Derives one entry and writes it, sealed, in place of what was there.
void dig_entry_refresh(struct dig_store *store, sqlite3_int64 ground, size_t trajectory);

#endif // DIG_TABLES_STORE_PRIVATE_H
