// What another depth or attack, or leaving the trajectory, adds to a plain dig.

#ifndef DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
#define DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H

#include "closed_loop/recordings/features.h"
#include "closed_loop/recordings/measured.h"

/// 1 sigma of what an unknown height of the ground adds, relative to the plain dig's amplitude. The
/// prior is uniform over the depths of the table, and the change is linear in depth (true to some
/// hundredths of a dig). gravel: NULL, or one about which the table has a hole, gives the mean over
/// the table's gravels. Deeper digs are read over the plain path, as a dig is whose ground is not
/// known. Zeros where the table has one depth of the trajectory. DIG_ENOMEM. Less than a
/// millisecond a gravel.
DIG_MUST_CHECK enum dig_status dig_depth_change(const struct dig_curve_set *set, size_t trajectory,
                                                const struct dig_gravel *gravel,
                                                double                   change[DIG_FEATURES]);

/// 1 sigma of what another approach adds in a gravel that was not dug so, relative to what is
/// predicted from its neighbours. In tables/product.sqlite: rms error of a gravel's change
/// predicted by the mean of two others, over three trajectories and four approaches, without the
/// beds' own scatter.
#define DIG_APPROACH_ERROR 0.3

/// The same for a dig that leaves its trajectory: at each point it counts as a dig of that depth.
#define DIG_PATH_ERROR 0.5

/// What another approach, or the nearest to it that the table was dug at, adds to the plain dig of
/// a gravel, over the plain path. deeper: how much deeper the dig is at each point besides, over
/// the depth (NULL: nowhere); at that point it adds what the whole dig's depth adds there. Zeros
/// where the table has none for the gravel. DIG_ENOMEM. Less than a millisecond.
DIG_MUST_CHECK enum dig_status
dig_approach_added(const struct dig_curve_set *set, size_t trajectory,
                   const struct dig_gravel *gravel, const struct dig_approach *approach,
                   const double deeper[DIG_CURVE_POINTS], struct dig_added *added);

#endif // DIG_CLOSED_LOOP_MODEL_APPROACH_CHANGE_H
