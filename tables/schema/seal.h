// Seals, which detect a flipped bit: a hash over an entry and its runs, kept beside it. Internal to
// tables/.
//
//   scene (hash, numbers), ground, trajectory, packings, mean, spread, and of every run packing,
//   seed, engine, version, grains, windows, times, curve, date, wall time   -- SHA-256 -->   63
//   bits
//
// Damage alone is detected: whoever can write the file can seal it. What a sum is of does not
// depend on rows' ids or order, so that merged tables have those of their inputs.

#ifndef DIG_TABLES_SCHEMA_SEAL_H
#define DIG_TABLES_SCHEMA_SEAL_H

#include "tables/schema/schema.h"

#include <stddef.h>

/// Seals one entry as it and its runs stand, in place of what was there.
void dig_seal_write(struct dig_db *db, sqlite3_int64 ground, size_t trajectory);

/// Refuses an entry that is not sealed, or is not, with its runs, what was sealed, and a run
/// without an entry: DIG_EINVAL, the first one named. Reads every run.
void dig_seal_check(struct dig_db *db);

#endif // DIG_TABLES_SCHEMA_SEAL_H
