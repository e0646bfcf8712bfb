// Covariance of one dig of a trajectory: scatter of the table's beds, unknown depth of the ground,
// and noise of the sensors.

#ifndef DIG_CLOSED_LOOP_FIT_BATCH_GROUP_H
#define DIG_CLOSED_LOOP_FIT_BATCH_GROUP_H

#include "closed_loop/fit/batch.h"

/// Fills features, size, noise of the sensors, whitening and log_det of a group whose digs are
/// known, from their features; place: as dig_batch_make(). DIG_ENOMATCH: the digs have not
/// half a channel in common.
DIG_MUST_CHECK enum dig_status dig_batch_group_fill(struct dig_batch *batch, size_t g,
                                                    const double feature[][DIG_FEATURES],
                                                    const double place[DIG_AXES]);

#endif // DIG_CLOSED_LOOP_FIT_BATCH_GROUP_H
