// What the effects found are explained in to people: the gravel, the table's bucket, and how hard
// the layers that tables of effects hold resist beside the gravel.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_GROUND_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_GROUND_H

#include "closed_loop/fit/hypothesis.h"
#include "estimator/effects/effect.h"

/// Of a fitted gravel. table: the file that the batch's surface was made of; NULL: its bucket is as
/// rough as the gravel. Opens the table. DIG_ENOMEM; fails as dig_table_scene().
DIG_MUST_CHECK enum dig_status
dig_trace_ground(const char *table, const struct dig_response_surface *surface,
                 const struct dig_whitened_digs *batch, const double place[DIG_AXES],
                 struct dig_effect_ground *ground, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_GROUND_H
