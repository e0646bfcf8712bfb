// A table on disk: its SQL, its version, and the checks of every opening. Internal to tables/;
// docs/formats/tables.md shows the schema to people.

#ifndef DIG_TABLES_SCHEMA_SCHEMA_H
#define DIG_TABLES_SCHEMA_SCHEMA_H

#include "core/curve.h"
#include "core/error.h"
#include "core/scene.h"

#include <sqlite3.h>
#include <stdbool.h>

#define DIG_TABLE_APPLICATION_ID 0x44494754 // "DIGT", at byte 68 of the file
#define DIG_TABLE_VERSION        4          // PRAGMA user_version

/// What a table says of itself, read once at opening.
struct dig_table_head {
    char                  scene_name[DIG_NAME_SIZE];
    char                  scene_hash[65];
    double                tooth_m, bucket_width_m, young_Pa, smooth_half_s;
    size_t                trajectories;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX]; // all of the scene, in its order
    double                depth_m[DIG_TRAJECTORY_MAX];    // dig_approach_depth_m() of each
    double                time_step_s;                    // of the scene
    struct dig_material   finest; // its smallest grains; of several spheres: of their volume
    enum dig_normal_law   normal;
    bool                  density_scales; // curves of two densities differ by their ratio alone
};

/// An open database, and its file's name, which lives as long. What fails first stays, in status
/// and *error: every step behind it does nothing, so that steps stand one behind the other and the
/// status is asked once, where they end.
struct dig_db {
    sqlite3          *sql;
    const char       *path;
    enum dig_status   status;
    struct dig_error *error; // of who asked last; NULL: nobody wants the words
};

/// What a scene's table says of itself.
void dig_table_head_of(const struct dig_scene *scene, struct dig_table_head *head);

/// The database has failed: *error becomes "PATH: " and what is formatted. Nothing, where it had
/// before.
__attribute__((format(printf, 3, 4))) void dig_db_fail(struct dig_db *db, enum dig_status status,
                                                       const char *format, ...);

/// The same with what SQLite says, and the status of a failed call.
void dig_sql_refuse(struct dig_db *db);

/// Settings of every connection, before anything is read: a file from elsewhere is not trusted. It
/// runs no triggers, views or functions of its own, nor has more, or larger, than a table needs.
void dig_sql_setup(struct dig_db *db);

/// Runs statements that return no rows.
void dig_sql_run(struct dig_db *db, const char *sql);

/// Prepares a statement; finalize it. NULL where the database has failed: to bind, to read and to
/// finalize that is harmless, and it has no row.
sqlite3_stmt *dig_sql_prepare(struct dig_db *db, const char *sql);

/// Prepares a statement and steps to its first row, which there must be.
sqlite3_stmt *dig_sql_first(struct dig_db *db, const char *sql);

/// Steps to the next row. False at the end, and where the database has failed.
bool dig_sql_row(struct dig_db *db, sqlite3_stmt *s);

/// Runs a statement that gives no rows, and finalizes it.
void dig_sql_done(struct dig_db *db, sqlite3_stmt *s);

/// Makes an empty database a table without rows, application_id and user_version with it.
void dig_schema_tables(struct dig_db *db);

/// Makes an empty database the table of this scene, in one transaction.
void dig_schema_create(struct dig_db *db, const struct dig_scene *scene);

/// Refuses a file whose schema is not, word for word, that of a table.
void dig_schema_compare(struct dig_db *db);

/// Refuses what is no table (DIG_EINVAL), another version (DIG_ESCHEMA, both named), and a damaged
/// file; then reads the head, and compares every entry and its runs with their seal
/// (tables/schema/seal.h). Writes *head on success only. Reads the whole file. What it found holds
/// for what is read in the same transaction.
void dig_schema_check(struct dig_db *db, struct dig_table_head *head);

#endif // DIG_TABLES_SCHEMA_SCHEMA_H
