// The gravel matched, with its posterior.

#ifndef DIG_CORE_GRAVEL_MATCH_H
#define DIG_CORE_GRAVEL_MATCH_H

#include "core/curve.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_MATCH_SAMPLES 32 // gravels drawn from the posterior

/// The match. Distances are ||measured - table|| / ||measured|| over the points measured, of all
/// digs that were pooled.
struct dig_match {
    bool     valid;
    uint32_t dig_count; // of the observation it came from, the youngest of several
    size_t   digs;      // pooled
    int      nearest;   // entry of the table
    double   nearest_distance;
    int weighted; // entry nearest by the noise-weighted distance (estimator/match/weighted.c); -1
    double            weighted_distance; // 1 is expected of digs of its gravel; NaN: not computed
    struct dig_gravel gravel; // between the grid points: of the smallest distance; where forces
                              // were measured, the most probable
    double            distance;
    struct dig_gravel mean, low, high;  // posterior mean and 5 %, 95 % of each axis
    struct dig_gravel mode;             // where the posterior is highest
    bool              forces;           // the posterior is of moment and forces
    bool              untold[DIG_AXES]; // undetermined axes; with any, the match is a family of
                                        // gravels (estimator/match/match.h)
    double            noise_floor;      // expected distance of another packing of the same gravel
    bool              outside;          // none of the table's gravels, by distance or by forces
    double            outside_floors;   // distance > this many noise floors is outside
    size_t            samples;          // 0 until refined
    struct dig_gravel sample[DIG_MATCH_SAMPLES]; // equally likely, in proportion to the posterior
};

#endif // DIG_CORE_GRAVEL_MATCH_H
