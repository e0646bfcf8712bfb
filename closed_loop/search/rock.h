// A rock that does not lie where the table's does.
//
// The beds of `obstacle` hold a rock at one place. Elsewhere along the drag it makes the same hump
// in a dig, shifted; at another depth the hump is larger or smaller, and not by as much along every
// trajectory. So: the template's hump by the tooth's x, shifted by one length for all trajectories,
// times one factor, 0 or more, for each; the gravel refitted with it. A rock that is buried is felt
// sooner than one on the ground: it may lie a quarter of a tooth further along than its hump says.

#ifndef DIG_CLOSED_LOOP_SEARCH_ROCK_H
#define DIG_CLOSED_LOOP_SEARCH_ROCK_H

#include "closed_loop/fit/hypothesis.h"

struct dig_rock {
    bool              known;                      // the table has a rock along every trajectory
    double            ahead_m;                    // of the table's rock, rig scale
    double            low_m, high_m;              // 90 % interval
    double            factor[DIG_TRAJECTORY_MAX]; // of the largest rock's hump, by group
    size_t            numbers;                    // fitted: the place, and factors that are not 0
    double            log_evidence, p_fit; // as a search judges it, 0 before: struct dig_candidate
    struct dig_fitted plain;               // the gravel without the hump; misfit and squares
                                           // with it
    double squares; // left of the means, with the noise that the plain hypothesis has alone
};

/// Fits it, starting from the plain hypothesis' fit. A tenth of a second.
struct dig_rock dig_rock_fit(const struct dig_batch *batch, const struct dig_fitted *plain);

#endif // DIG_CLOSED_LOOP_SEARCH_ROCK_H
