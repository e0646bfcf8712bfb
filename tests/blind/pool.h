// The digs that blind campaigns are made of: force recordings whose gravel and effect are known,
// none of them in any table.

#ifndef DIG_TESTS_BLIND_POOL_H
#define DIG_TESTS_BLIND_POOL_H

#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"

#include <stdbool.h>
#include <stddef.h>

/// Trajectories the bench uses, in this order everywhere: a simple one, the real one, and another
/// simple one that not all beds were dug along.
enum blind_path { BLIND_SIMPLE, BLIND_ACTUAL, BLIND_OTHER_SIMPLE, BLIND_PATHS };

const char *blind_path_name(enum blind_path path);

/// One bed, dug along each path from the same start.
struct blind_bed {
    unsigned             packing;
    struct dig_recording dig[BLIND_PATHS]; // rows 0: not dug
};

#define BLIND_BEDS_MAX 16

/// Beds of one gravel, effect and magnitude, by one DEM code.
struct blind_group {
    char              source[16];            // "liggghts", "ours"
    char              effect[DIG_NAME_SIZE]; // "": plain
    bool              outside;               // the effect is not of the catalogue
    double            magnitude;
    struct dig_gravel gravel;
    size_t            beds;
    struct blind_bed  bed[BLIND_BEDS_MAX];
};

struct blind_pool {
    size_t              groups;
    struct blind_group *group;
};

/// Reads the digs of LIGGGHTS under data/reference, data/liggghts_digs and data/liggghts_more, and
/// ours in data/blind/*.sqlite, as far as they are there; to judge with, also in data/blind/judge.
/// A table there whose runs have no effect and whose file is not "plain" holds an effect of its
/// file's name, up to a dash, of the magnitude behind "=", or 1. Only beds dug along the first two
/// paths are kept.
DIG_MUST_CHECK enum dig_status blind_pool_read(const char *data, bool to_judge,
                                               struct blind_pool *pool, struct dig_error *error);

void blind_pool_finish(struct blind_pool *pool);

/// Whether all beds of a group were dug along a path.
bool blind_group_has(const struct blind_group *group, enum blind_path path);

/// The plain group of that gravel and source, or NULL.
const struct blind_group *blind_pool_plain(const struct blind_pool  *pool,
                                           const struct blind_group *like);

#endif // DIG_TESTS_BLIND_POOL_H
