// The depth of a dig, told by all of its curve.
//
// A machine does not know where the ground lies: the first grain it meets may lie a grain higher or
// lower. So the depth is one more unknown. At depths over the table's range the dig is compared
// with the table's curves dug so, all laid over one path, so that every depth is judged by the same
// points:
//
//   evidence(depth) = mean over gravels of L(dig | gravel, depth)      L of posterior.h
//
// The depth is where a parabola through the best three has its top.

#ifndef DIG_ESTIMATOR_MATCH_DEPTH_H
#define DIG_ESTIMATOR_MATCH_DEPTH_H

#include "core/curve.h"
#include "core/observation.h"
#include "estimator/approach/approach_error.h"

#include <stddef.h>

/// Bytes of the memory dig_depth_fit() wants: 0, and NULL is allowed, for a table of one depth.
size_t dig_depth_fit_size(const struct dig_curve_set *set);

/// Tells the depth of a dig as dig_recorded_dig_observe() observed it, and lays it over its own
/// path: made, approach and off_path_m are then what they say. Does nothing where the table has one
/// depth of its trajectory. A dig at the end of the table's depths that seems to lie beyond them is
/// matched at that end; what it lies beyond is distance from the path. DIG_ENOMATCH: that is more
/// than limit_m. DIG_EINVAL: it fails dig_observations_check(). Writes on success only. error: of
/// each of the set's trajectories, as dig_approach_error_measure() has it. As long as nine
/// dig_approached_make() of one slot; 300 kB of stack.
DIG_MUST_CHECK enum dig_status dig_depth_fit(const struct dig_curve_set     *set,
                                             const struct dig_approach_error error[],
                                             double limit_m, void *memory,
                                             struct dig_observation *dig);

#endif // DIG_ESTIMATOR_MATCH_DEPTH_H
