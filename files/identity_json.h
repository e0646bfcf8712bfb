// A gravel that was identified, as a JSON file (docs/formats.md): written by `digloop identify
// --json`, read back by `digloop predict --identified`.

#ifndef DIG_FILES_IDENTITY_JSON_H
#define DIG_FILES_IDENTITY_JSON_H

#include "core/error.h"
#include "core/gravel_match.h"
#include "core/observation.h"

#include <stdbool.h>
#include <stdio.h>

#define DIG_IDENTITY_DIGS_MAX 8

/// A dig it was identified from. The file names its trajectory: the observation's is 0 when read,
/// and so is all that is kept of no dig (count, ending, how it was made, distance from the path).
struct dig_identity_dig {
    char                   trajectory[DIG_NAME_SIZE];
    struct dig_observation seen;
};

/// The file knows the table's entries by their gravel. When read, the match is valid, its `nearest`
/// is 0, and its `weighted` 0 where there is one; mode, untold and outside_floors are not kept.
struct dig_identity {
    char                scene_hash[65];            // of the table it was identified with
    char                trajectory[DIG_NAME_SIZE]; // of the dig it was identified on
    struct dig_approach made;    // how that dig was made, from its own path; depth 0: not known
    struct dig_approach matched; // the nearest to that the table knows; zeroed: the plain one
    struct dig_match    match;
    struct dig_gravel   nearest;          // entry of the table
    struct dig_gravel   weighted_nearest; // and by the noise-weighted distance; match.weighted >= 0
    bool                family;           // the digs do not resolve an axis: one of a family
    // The last of the digs, oldest first, for who goes on with them; 0: they are not kept.
    size_t                  recorded;
    struct dig_identity_dig recording[DIG_IDENTITY_DIGS_MAX];
};

/// One JSON object and a line feed; "recorded" only where there is one.
void dig_identity_write(FILE *to, const struct dig_identity *identity);

/// DIG_EINVAL names file, line, key and what was expected; DIG_EIO: it cannot be opened. Writes on
/// success only.
DIG_MUST_CHECK enum dig_status dig_identity_read(const char *path, struct dig_identity *identity,
                                                 struct dig_error *error);

#endif // DIG_FILES_IDENTITY_JSON_H
