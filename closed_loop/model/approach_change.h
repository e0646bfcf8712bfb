// What a dig does otherwise than the table's: deeper or less deep, or with the bucket turned.

#ifndef DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
#define DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H

#include "closed_loop/recordings/features.h"
#include "closed_loop/recordings/measured.h"

/// 1 sigma of the change where the ground lies higher or lower, relative to the plain dig's
/// amplitude, of a gravel (where it is not known, NULL, or the table has a hole about it, mean over
/// the table's): every depth that the table was dug at is as likely, and the change goes straight
/// with it, as it does to some hundredths of a dig. A dig whose ground is not known is read over
/// the plain path, and so is the deeper one here. Zeros where the table has one depth of the
/// trajectory. DIG_ENOMEM. Less than a millisecond a gravel.
DIG_MUST_CHECK enum dig_status dig_depth_change(const struct dig_curve_set *set, size_t trajectory,
                                                const struct dig_gravel *gravel,
                                                double                   change[DIG_FEATURES]);

/// What a gravel does at another approach, over what others nearby say of it, is off by 1 sigma of
/// this share: in tables/product.sqlite a gravel's change from what the two others' mean says, root
/// mean square over three trajectories and four approaches, without the beds' own scatter.
#define DIG_APPROACH_ERROR 0.3

/// The same of a dig that leaves its trajectory: it is taken for as deep everywhere as it is there.
#define DIG_PATH_ERROR 0.5

/// What a dig of a gravel at another approach, or the nearest to it that the table was dug at, adds
/// to the plain one; over the plain path. deeper: how much deeper it is besides at each point, as a
/// share of the depth (NULL: nowhere); that changes the dig as the whole dig's depth does there.
/// Zeros where the table has none for the gravel. DIG_ENOMEM. Less than a millisecond.
DIG_MUST_CHECK enum dig_status
dig_approach_added(const struct dig_curve_set *set, size_t trajectory,
                   const struct dig_gravel *gravel, const struct dig_approach *approach,
                   const double deeper[DIG_CURVE_POINTS], struct dig_added *added);

#endif // DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
