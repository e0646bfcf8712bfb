// The table at other depths and attacks, interpolated between those it was dug at; a curve set like
// any other.
//
// A gravel that was dug at enough of them is interpolated from its own curves, with the weights of
// estimator/approach/approaches.h, at equal times (a phase lasts as long however deep it goes).
// Another one borrows the change of others, relative to the size of their curves, the nearest
// gravels most. The spread of one dig grows by the interpolation error of
// estimator/approach/approach_error.h.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACHED_H
#define DIG_ESTIMATOR_APPROACH_APPROACHED_H

#include "core/approach.h"
#include "core/curve.h"
#include "estimator/approach/approach_error.h"

#include <stddef.h>

struct dig_cell; // estimator/approach/interpolate.h

/// One trajectory of the table made: one of the set's, dug so.
struct dig_approached_slot {
    size_t              trajectory;
    struct dig_approach approach;   // in the hull: dig_approach_clamp()
    double              over_depth; // its curves are laid over the path at this depth
                                    // (estimator/approach/laid.h); 0: over their own
    const struct dig_cell *only; // of the set along the trajectory: its entries alone are made, the
                                 // others lack the slot; NULL: all are
};

/// Bytes of the memory dig_approached_make() wants: 8 kB an entry and slot, 17 kB an entry dug at
/// other approaches.
size_t dig_approached_size(const struct dig_curve_set *set, size_t slots);

/// The set with these slots as its trajectories, 1 to DIG_TRAJECTORY_MAX, in memory (aligned as
/// malloc does). Gravels, entries and grid are the set's own, which must outlive it. A slot that is
/// plain has the set's curves bit by bit. An entry for which neither its own nor others' digs reach
/// lacks the trajectory. About 0.1 ms an entry and slot.
/// error: of each of the set's trajectories, as dig_approach_error_measure() has it; NULL: measured
/// here, which takes longer than all else.
const struct dig_curve_set *dig_approached_make(const struct dig_curve_set *set, size_t slots,
                                                const struct dig_approached_slot slot[],
                                                const struct dig_approach_error  error[],
                                                void                            *memory);

#endif // DIG_ESTIMATOR_APPROACH_APPROACHED_H
