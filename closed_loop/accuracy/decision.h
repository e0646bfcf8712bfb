// Decides whether to apply a correction. One that is small beside the scatter of one dig makes the
// next dig's error worse nearly as often as better, even where it is right.

#ifndef DIG_CLOSED_LOOP_ACCURACY_DECISION_H
#define DIG_CLOSED_LOOP_ACCURACY_DECISION_H

#include "closed_loop/accuracy/judge.h"

/// Chance, 0 … 1, that the curves after are farther from the next dig than those before, if they
/// are exactly its mean: averaged over these digs. A correction d of the moment makes a dig that
/// scatters by e worse where 2 <d, e> < -<d, d>, products over rig time. e is normal, as large as
/// the curves' before.sd and correlated from bin to bin as the scatter is. 1/2 where d is 0.
double dig_decision_chance_of_worse(const struct dig_judged  *judged,
                                    const struct dig_scatter *scatter);

/// Whether the moment's error (docs/numerics.md) after is below that before, over the fitted digs.
bool dig_decision_brings_nearer(const struct dig_judged *judged, const bool fit[]);

#endif // DIG_CLOSED_LOOP_ACCURACY_DECISION_H
