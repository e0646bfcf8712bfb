// The depths and attacks a table was dug at, as points of a plane, and what lies between them.
//
//   attack               o  dug: what a curve is interpolated between
//     |       o          .  the plain one, dug by every gravel
//     |     / | \        x  outside the hull: told by its nearest place in it,
//     |   o - . - o      and by how far that is
//     |     \ | /    x
//     |       o
//     +-------------- depth
//
// Distances in the plane are those of paths (estimator/track/route.h): metres the tooth is deeper,
// and tooth_m times the angle.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACHES_H
#define DIG_ESTIMATOR_APPROACH_APPROACHES_H

#include "core/approach_set.h"
#include "core/curve.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_NODES_MAX 72 // ways a trajectory is dug, the plain one among them; more are passed over

/// What one gravel was dug at along one trajectory; the plain one first.
struct dig_nodes {
    size_t                  nodes;
    struct dig_approach     approach[DIG_NODES_MAX];
    int                     packings[DIG_NODES_MAX];
    const struct dig_curve *curve[DIG_NODES_MAX];
};

/// Those of an entry of the set; none where it lacks the trajectory.
void dig_nodes_of(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                  struct dig_nodes *nodes);

/// How far apart two ways of digging a trajectory of the set are, m.
double dig_approach_distance_m(const struct dig_curve_set *set, size_t trajectory,
                               const struct dig_approach *a, const struct dig_approach *b);

/// The nearest to *approach in the hull of all that any gravel was dug at along the trajectory, and
/// how far it is, m; without further approaches the plain one. O(entries of set->approaches).
double dig_approach_clamp(const struct dig_curve_set *set, size_t trajectory,
                          const struct dig_approach *approach, struct dig_approach *nearest);

/// What each node weighs at an approach: bilinear where the four corners of its cell were dug, else
/// piecewise linear along depth plus the same along attack. The weights add up to 1; at a node they
/// are 1 and 0. Linear, as a second power through three noisy curves would gain half a percent of a
/// curve that bends with the square of depth, and lose more to the scatter of their means. False
/// when the nodes do not reach so far; then nothing is written.
bool dig_approach_weigh(const struct dig_nodes *nodes, const struct dig_approach *approach,
                        double weight[DIG_NODES_MAX]);

/// The digs on one axis (the other plain) between which a depth, or an attack in rad, lies; equal
/// at one of them. False when it lies beyond them all.
bool dig_approach_span(const struct dig_nodes *nodes, bool attack, double value, double *low,
                       double *high);

#endif // DIG_ESTIMATOR_APPROACH_APPROACHES_H
