// Tables from before digs had a depth and an attack angle, or entries a seal, made today's in place
// when the first run is added.

#include "tables/schema/schema.h"
#include "tables/schema/seal.h"

#include <stdio.h>

// The key over more columns wants the table made anew; rows keep their ids, and what refers to
// them its sense.
static const char approach_sql[] = "DROP VIEW temp.ground;" DIG_GROUND_SQL("ground_new") //
    "INSERT INTO ground_new SELECT id, friction, rolling, density_kgpm3, effect, magnitude, 1.0, "
    "0.0 FROM main.ground ORDER BY id;"
    "DROP TABLE main.ground;"
    "ALTER TABLE ground_new RENAME TO ground;";

static enum dig_status upgrade(const struct dig_db *const db, const int version,
                               struct dig_error *const error)
{
    enum dig_status status = dig_sql_run(db, "BEGIN IMMEDIATE", error);
    if (status == DIG_OK && version == DIG_TABLE_VERSION_PLAIN) {
        status = dig_sql_run(db, approach_sql, error);
    }
    if (status == DIG_OK) {
        status = dig_sql_run(db, DIG_SEAL_SQL, error);
    }
    if (status == DIG_OK) {
        status = dig_seal_write_all(db, error);
    }
    if (status == DIG_OK) {
        status = dig_schema_number(db, error);
    }
    return status == DIG_OK ? dig_sql_run(db, "COMMIT", error) : status;
}

enum dig_status dig_schema_upgrade(const struct dig_db *const db, const int version,
                                   struct dig_error *const error)
{
    enum dig_status status = dig_sql_run(db, "PRAGMA foreign_keys = OFF", error);
    if (status == DIG_OK) {
        status = upgrade(db, version, error);
    }
    if (status != DIG_OK) {
        (void)sqlite3_exec(db->sql, "ROLLBACK", NULL, NULL, NULL);
        return status;
    }
    return dig_sql_run(db, "PRAGMA foreign_keys = ON", error);
}
