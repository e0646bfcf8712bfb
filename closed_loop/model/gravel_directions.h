// The directions in which gravels about one differ, among all those of a dig's features: one for
// each axis of the table. A bed differs from the next of its gravel most of all along them.

#ifndef DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H
#define DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H

#include "closed_loop/model/response_surface.h"

/// Whitens, by S = L L', what a step along each axis changes of a gravel's dig, and makes the three
/// orthogonal and of length 1; of one that is a sum of those before it nothing is left.
void dig_gravel_directions_whiten(const double lower[DIG_FEATURES][DIG_FEATURES],
                                  double       change[DIG_AXES][DIG_FEATURES]);

/// The variance over S of a residual, which is relative to amplitude, along the directions at a
/// place: their mean.
double dig_gravel_directions_variance(const struct dig_response_surface *surface, size_t trajectory,
                                      const double place[DIG_AXES],
                                      const double lower[DIG_FEATURES][DIG_FEATURES],
                                      const double residual[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_MODEL_GRAVEL_DIRECTIONS_H
