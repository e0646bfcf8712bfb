// Opens SQLite files. What stands beside a table may come from anybody, too: SQLite looks for
// PATH-journal and PATH-wal by name, and acts on what they say.

#ifndef DIG_TABLES_OPEN_H
#define DIG_TABLES_OPEN_H

#include "tables/schema/schema.h"

/// Opens the file of its very name, whatever SQLite would read in it, with SQLite's flags, and
/// restricts the connection as dig_sql_setup() does. Of files beside it only regular ones are
/// opened, through no link. A journal that names a journal of several databases, which no table of
/// ours has, is rolled back no further than its own table: SQLite would delete the file so named,
/// whatever it is. The owner of *db closes db->sql, also where this fails.
void dig_sql_open(struct dig_db *db, int flags);

#endif // DIG_TABLES_OPEN_H
