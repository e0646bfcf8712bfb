// Whether digs drift from first to last as wear is taken to, by the same share from one to the
// next.
//
// Of every dig the size that it has over the gravel's without wear, f = <y, m> / <m, m>, with a
// variance of 1 / <m, m>, is fitted by a line and by a parabola in the digs' order; what the digs
// of one trajectory share counts as its own unknown. A strength that grows and comes to rest, or
// steps once, is a drift, too, but of something else than a tooth, and a line through it overshoots
// the next dig.

#ifndef DIG_CLOSED_LOOP_SEARCH_DRIFT_H
#define DIG_CLOSED_LOOP_SEARCH_DRIFT_H

#include "closed_loop/fit/hypothesis.h"

/// How many sigmas the parabola's own term is from nothing, of a fit that holds wear; of any other,
/// or of fewer than five digs: 0. Microseconds.
double dig_drift_bend(const struct dig_whitened_digs *batch, const struct dig_soil *soil,
                      const struct dig_fitted *fitted);

#endif // DIG_CLOSED_LOOP_SEARCH_DRIFT_H
