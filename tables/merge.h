// Several tables of one scene brought together into a new one.
//
// The result does not depend on the order of the inputs, nor on how the runs were dealt out to
// them: rows stand in the order of their keys, and the file's bytes follow from the rows alone.

#ifndef DIG_TABLES_MERGE_H
#define DIG_TABLES_MERGE_H

#include "core/error.h"

#include <stddef.h>

/// Writes the runs of all inputs, each once, with their entries to path, which must not exist: into
/// PATH.part, then renamed. A run that several inputs hold must be the same in all, but for the
/// wall time and the date it was made, of which the earliest stays. DIG_EINVAL, DIG_ESCHEMA: an
/// input that is no table or of another scene, two runs that differ; both files are named, and
/// nothing is left behind. DIG_EIO, DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_store_merge(const char *path, size_t inputs,
                                               const char *const input[], struct dig_error *error);

#endif // DIG_TABLES_MERGE_H
