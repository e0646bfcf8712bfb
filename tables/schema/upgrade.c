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

void dig_schema_upgrade(struct dig_db *const db, const int version)
{
    dig_sql_run(db, "PRAGMA foreign_keys = OFF; BEGIN IMMEDIATE");
    if (version == DIG_TABLE_VERSION_PLAIN) {
        dig_sql_run(db, approach_sql);
    }
    dig_sql_run(db, DIG_SEAL_SQL);
    dig_seal_write_all(db);
    dig_schema_number(db);
    dig_sql_run(db, "COMMIT");
    if (db->status != DIG_OK) {
        (void)sqlite3_exec(db->sql, "ROLLBACK", NULL, NULL, NULL);
    }
    dig_sql_run(db, "PRAGMA foreign_keys = ON");
}
