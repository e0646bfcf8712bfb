// One entry of a table by number: the plain ones first, then those dug deeper or with the bucket
// turned, as dig_export_list() numbers them. Internal to tables/ and to digtable.

#ifndef DIG_TABLES_LISTED_H
#define DIG_TABLES_LISTED_H

#include "core/curve.h"
#include "core/entry_set.h"

/// What one entry holds of one trajectory. The curve is the set's; packings 0: not computed.
struct dig_listed {
    struct dig_gravel       gravel;
    struct dig_approach     approach;
    struct dig_trajectory   trajectory; // as dug
    int                     packings;
    const struct dig_curve *curve;
};

/// Plain and other entries together.
size_t dig_listed_count(const struct dig_curve_set *set);

/// entry < dig_listed_count(), trajectory < set->trajectories.
struct dig_listed dig_listed_at(const struct dig_curve_set *set, size_t entry, size_t trajectory);

#endif // DIG_TABLES_LISTED_H
