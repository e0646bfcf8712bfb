// The table the matching thread uses, and the one it replaced.
//
// A table lives until no thread reads it: after an exchange the matching thread uses the new one at
// once, the tick from its next pause between two digs, the publisher with the tick. Each says by a
// generation number which table it uses; the old table is freed when both have reached the new one.

#ifndef DIG_FIRMWARE_HOST_MATCHING_TABLE_IN_USE_H
#define DIG_FIRMWARE_HOST_MATCHING_TABLE_IN_USE_H

#include "core/curve.h"
#include "firmware_host/matching/matcher.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/// Initialised with set, generation 1, lambda and the two atomics.
struct dig_table_in_use {
    struct dig_curve_set *set;        // owned
    struct dig_curve_set *retiring;   // the one before, while a thread may read it; owned; or NULL
    int64_t               generation; // of set, counted from 1
    double                lambda;     // machine's tooth length / set's
    struct dig_matcher    matcher;    // of set
    const atomic_llong   *tick_generation;      // in use by the tick
    const atomic_llong   *publisher_generation; // in use by the publisher
};

/// Takes the set over as the next generation. Only while retiring is NULL.
void dig_table_in_use_exchange(struct dig_table_in_use *table, struct dig_curve_set *set,
                               double lambda);

/// True when the tick uses the current generation.
bool dig_table_in_use_by_tick(const struct dig_table_in_use *table);

/// Frees the table before once tick and publisher use the current one.
void dig_table_in_use_retire(struct dig_table_in_use *table);

/// Frees both tables and the matcher.
void dig_table_in_use_finish(struct dig_table_in_use *table);

#endif // DIG_FIRMWARE_HOST_MATCHING_TABLE_IN_USE_H
