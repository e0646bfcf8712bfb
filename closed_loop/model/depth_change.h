// What a dig does where its ground lies higher or lower than the table has it.

#ifndef DIG_CLOSED_LOOP_MODEL_DEPTH_CHANGE_H
#define DIG_CLOSED_LOOP_MODEL_DEPTH_CHANGE_H

#include "closed_loop/recordings/features.h"

/// 1 sigma of that change, relative to the plain dig's amplitude, of a gravel (NULL: mean over the
/// table's): every depth that the table was dug at is as likely, and the change goes straight with
/// it, as it does to some hundredths of a dig. A dig whose ground is not known is read over the
/// plain path, and so is the deeper one here. Zeros where the table has one depth of the
/// trajectory. DIG_ENOMEM. About 0.2 ms an entry.
DIG_MUST_CHECK enum dig_status dig_depth_change(const struct dig_curve_set *set, size_t trajectory,
                                                const struct dig_gravel *gravel,
                                                double                   change[DIG_FEATURES]);

/// What a dig of a gravel adds to the plain one at another depth, the nearest to it that the table
/// was dug at; over the plain path. Zeros where the table has none for the gravel. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_depth_added(const struct dig_curve_set *set, size_t trajectory,
                                               const struct dig_gravel *gravel, double depth,
                                               double added[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

#endif // DIG_CLOSED_LOOP_MODEL_DEPTH_CHANGE_H
