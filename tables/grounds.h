// The grounds of a table in memory (gravel, effect, approach), and the curves of each. Internal to
// tables/.

#ifndef DIG_TABLES_GROUNDS_H
#define DIG_TABLES_GROUNDS_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/error.h"
#include "tables/schema/schema.h"

#include <stdbool.h>

enum dig_grounds_kind {
    DIG_GROUNDS_PLAIN,      // without an effect, as the trajectories stand
    DIG_GROUNDS_VARIED,     // with an effect, likewise
    DIG_GROUNDS_APPROACHED, // without an effect, at another depth or attack
    DIG_GROUNDS_ALL,
};

struct dig_ground {
    sqlite3_int64       id;
    struct dig_gravel   gravel;
    char                effect[DIG_NAME_SIZE]; // "": none
    double              magnitude;
    struct dig_approach approach;
};

/// Ordered by gravel, effect, magnitude, depth, attack. packings 0: not dug.
struct dig_grounds {
    size_t             grounds, trajectories;
    struct dig_ground *ground;   // [grounds]
    int               *packings; // [grounds * trajectories]
    struct dig_curve  *curve;    // [grounds * trajectories]
};

/// Reads and checks them; there may be none. Call it in a transaction. Free with
/// dig_grounds_finish().
DIG_MUST_CHECK enum dig_status
dig_grounds_load(sqlite3 *db, const char *path, const struct dig_table_head *head,
                 enum dig_grounds_kind kind, struct dig_grounds *grounds, struct dig_error *error);

/// Gives entries with one packing the spread the others have at the same point of the path,
/// relative to the curve's rms: variances pooled by their degrees of freedom. others: grounds along
/// the same trajectories whose spread is added to the pool; NULL: none.
void dig_grounds_pool_spread(const struct dig_grounds *others, struct dig_grounds *grounds);

/// The time step of the head's scene against what the lightest of these gravels bears.
struct dig_table_step dig_grounds_step(const struct dig_grounds    *grounds,
                                       const struct dig_table_head *head);

void dig_grounds_finish(struct dig_grounds *grounds);

#endif // DIG_TABLES_GROUNDS_H
