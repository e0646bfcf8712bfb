// A table's further axes: the same digs deeper or with the bucket turned, at gravels of the table.
// Loaded by tables/load_approaches.h beside the plain curves.

#ifndef DIG_CORE_APPROACH_SET_H
#define DIG_CORE_APPROACH_SET_H

#include "core/approach.h"
#include "core/curve.h"

/// One gravel dug in one way that is not the plain one.
struct dig_approach_entry {
    struct dig_gravel   gravel;
    struct dig_approach approach;
};

/// Flat and read-only. curve[entry * trajectories + trajectory], over the path of the trajectory
/// dug so; packings 0: not computed.
struct dig_approach_set {
    size_t                     trajectories;                // as in the table, in its order
    double                     depth_m[DIG_TRAJECTORY_MAX]; // dig_approach_depth_m() of each
    size_t                     entries;  // ordered by gravel, depth, attack; at least one
    struct dig_approach_entry *entry;    // [entries]
    int                       *packings; // [entries * trajectories]
    struct dig_curve          *curve;    // [entries * trajectories]
};

#endif // DIG_CORE_APPROACH_SET_H
