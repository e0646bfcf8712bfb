// The covariance of digs of one gravel, from the runs of a table. Internal to tables/.

#ifndef DIG_TABLES_LOAD_COVARIANCE_H
#define DIG_TABLES_LOAD_COVARIANCE_H

#include "core/curve.h"
#include "core/error.h"
#include "tables/schema/schema.h"

/// Fills set->covariance from all runs without an effect, as the trajectories stand. Of a gravel
/// that was dug once nothing is learnt. Reads every such run: 0.1 ms each. DIG_EINVAL: a run that
/// cannot be one. Call it in a transaction.
DIG_MUST_CHECK enum dig_status dig_sql_load_covariance(const struct dig_db         *db,
                                                       const struct dig_table_head *head,
                                                       struct dig_curve_set        *set,
                                                       struct dig_error            *error);

#endif // DIG_TABLES_LOAD_COVARIANCE_H
