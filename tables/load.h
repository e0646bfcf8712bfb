// A table from disk to memory: flat, read-only, ready for the matcher. No SQLite type is seen here.

#ifndef DIG_TABLES_LOAD_H
#define DIG_TABLES_LOAD_H

#include "core/curve.h"
#include "core/entry_set.h"
#include "core/error.h"

/// Opens path read-only, checks version and integrity, and builds the curve set of what was dug
/// without an effect, as the trajectories stand; what was dug deeper or with the bucket turned is
/// in set->approaches, or NULL there. The curves are smoothed with +-0.16 s of rig time, mapped to
/// path progress, averaged over packings. Where density is a scale of the scene and one was dug,
/// there are three (tables/density_scale.h). Allocates; free with dig_curve_set_destroy().
/// DIG_ESCHEMA: another version, both named. DIG_EINVAL: nothing was dug without
/// an effect.
DIG_MUST_CHECK enum dig_status dig_table_load(const char *path, struct dig_curve_set **set,
                                              struct dig_error *error);

/// All a table holds, as it was dug: the curves without an effect and those with one, either of
/// which may have no entries. effects may be NULL; free it with dig_entry_set_destroy().
DIG_MUST_CHECK enum dig_status dig_table_list(const char *path, struct dig_curve_set **plain,
                                              struct dig_entry_set **effects,
                                              struct dig_error      *error);

/// Opens path read-only, checks it as dig_table_load() does, and builds the set of what was dug
/// with an effect, ordered by effect. DIG_EINVAL: there is nothing such in it, or it is of another
/// scene than plain (both named). Allocates; free with dig_entry_set_destroy().
DIG_MUST_CHECK enum dig_status dig_effects_load(const char *path, const struct dig_curve_set *plain,
                                                struct dig_entry_set **set,
                                                struct dig_error      *error);

/// NULL is allowed.
void dig_curve_set_destroy(struct dig_curve_set *set);
void dig_entry_set_destroy(struct dig_entry_set *set);

#endif // DIG_TABLES_LOAD_H
