// Cross-validation: whether the chosen effects predict left-out digs better than no effect does.

#ifndef DIG_CLOSED_LOOP_SEARCH_CROSS_VALIDATION_H
#define DIG_CLOSED_LOOP_SEARCH_CROSS_VALIDATION_H

#include "closed_loop/fit/hypothesis.h"

/// Leaves out each dig in turn, fits both hypotheses to the others, and predicts it: by the plain
/// one, and by both, weighed by their evidence from the others. The sum over digs of
/// |y - plain|^2 - |y - weighed|^2, in squares of the scatter of one dig. Above 0 the effects
/// predict digs to which they were not fitted. A dig without which the effects cannot be fitted
/// counts 0. Milliseconds a dig.
double dig_cross_validation_gain(const struct dig_batch *batch, const struct dig_fitted *plain,
                                 const struct dig_fitted *chosen);

#endif // DIG_CLOSED_LOOP_SEARCH_CROSS_VALIDATION_H
