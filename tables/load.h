// A table from disk to memory: flat, read-only, ready for the matcher. No SQLite type is seen here.

#ifndef DIG_TABLES_LOAD_H
#define DIG_TABLES_LOAD_H

#include "core/curve.h"
#include "core/error.h"

/// Opens path read-only, checks version and integrity, and builds the curve set. The curves are
/// smoothed with +-0.16 s of rig time, mapped to path progress, averaged over packings. Allocates;
/// free with dig_curve_set_destroy(). DIG_ESCHEMA: a version this build does not know, both named.
DIG_MUST_CHECK enum dig_status dig_table_load(const char *path, struct dig_curve_set **set,
                                              struct dig_error *error);

/// NULL is allowed.
void dig_curve_set_destroy(struct dig_curve_set *set);

#endif // DIG_TABLES_LOAD_H
