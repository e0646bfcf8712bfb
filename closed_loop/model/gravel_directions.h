// Directions of feature space in which neighbouring gravels differ, one for each axis of the table.
// Beds of one gravel differ most along them.

#ifndef DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H
#define DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H

#include "closed_loop/model/response_surface.h"

/// Whitens, by S = L L', the change of a gravel's dig along each axis, and makes the three
/// orthonormal, in place. One that depends linearly on those before it becomes 0.
void dig_gravel_directions_whiten(const double lower[DIG_FEATURES][DIG_FEATURES],
                                  double       change[DIG_AXES][DIG_FEATURES]);

/// Variance over S of a residual (relative to amplitude) along the directions at a place, mean over
/// them.
double dig_gravel_directions_variance(const struct dig_response_surface *surface, size_t trajectory,
                                      const double place[DIG_AXES],
                                      const double lower[DIG_FEATURES][DIG_FEATURES],
                                      const double residual[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H
