// What a dig does otherwise than the table's: deeper or less deep, or with the bucket turned.

#ifndef DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
#define DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H

#include "closed_loop/recordings/features.h"
#include "closed_loop/recordings/measured.h"

/// 1 sigma of the change where the ground lies higher or lower, relative to the plain dig's
/// amplitude, of a gravel (NULL: mean over the table's): every depth that the table was dug at is
/// as likely, and the change goes straight with it, as it does to some hundredths of a dig. A dig
/// whose ground is not known is read over the plain path, and so is the deeper one here. Zeros
/// where the table has one depth of the trajectory. DIG_ENOMEM. About 0.2 ms an entry.
DIG_MUST_CHECK enum dig_status dig_depth_change(const struct dig_curve_set *set, size_t trajectory,
                                                const struct dig_gravel *gravel,
                                                double                   change[DIG_FEATURES]);

/// What a dig of a gravel at another approach, or the nearest to it that the table was dug at, adds
/// to the plain one; over the plain path. Zeros where the table has none for the gravel.
/// DIG_ENOMEM. About 0.2 ms an entry.
DIG_MUST_CHECK enum dig_status dig_approach_added(const struct dig_curve_set *set,
                                                  size_t                      trajectory,
                                                  const struct dig_gravel    *gravel,
                                                  const struct dig_approach  *approach,
                                                  struct dig_added           *added);

#endif // DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
