// The depths and attacks a table was dug at, as points of a plane, and weights between them.
//
//   attack               o  dug: what a curve is interpolated between
//     |       o          .  the plain one, dug by every gravel
//     |     / | \        x  outside the hull: represented by its nearest point
//     |   o - . - o         in the hull, and the distance to it
//     |     \ | /    x
//     |       o
//     +-------------- depth
//
// Distances in the plane are those of paths (estimator/track/route.h): metres the tooth is deeper,
// and tooth_m times the angle.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACHES_H
#define DIG_ESTIMATOR_APPROACH_APPROACHES_H

#include "core/curve.h"
#include "core/entry_set.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_NODES_MAX 72 // approaches of a trajectory, the plain one included; more are skipped

/// The approaches one gravel was dug at along one trajectory; the plain one first.
struct dig_nodes {
    size_t                  nodes;
    struct dig_approach     approach[DIG_NODES_MAX];
    int                     packings[DIG_NODES_MAX];
    const struct dig_curve *curve[DIG_NODES_MAX];
};

/// Those of an entry of the set; none where it lacks the trajectory.
void dig_nodes_of(const struct dig_curve_set *set, size_t entry, size_t trajectory,
                  struct dig_nodes *nodes);

/// Distance of two approaches of a trajectory of the set, m.
double dig_approach_distance_m(const struct dig_curve_set *set, size_t trajectory,
                               const struct dig_approach *a, const struct dig_approach *b);

/// The nearest to *approach in the hull of all that any gravel was dug at along the trajectory, and
/// how far it is, m; without further approaches the plain one. O(entries of set->approaches).
double dig_approach_clamp(const struct dig_curve_set *set, size_t trajectory,
                          const struct dig_approach *approach, struct dig_approach *nearest);

/// Weights of the nodes at an approach: bilinear where the four corners of its cell were dug, else
/// piecewise linear along depth plus the same along attack. They add up to 1; at a node they are 1
/// and 0. A parabola would gain half a percent for a curve quadratic in depth, and lose more to the
/// scatter of three means. False, and nothing is written, when the nodes do not reach so far.
bool dig_approach_weigh(const struct dig_nodes *nodes, const struct dig_approach *approach,
                        double weight[DIG_NODES_MAX]);

/// Its attack in rad, or its depth.
double dig_approach_on_axis(const struct dig_approach *approach, bool attack);

/// The digs on one axis (the other plain) around a depth, or around an attack in rad; equal at one
/// of them. False when it lies beyond them all.
bool dig_approach_span(const struct dig_nodes *nodes, bool attack, double value, double *low,
                       double *high);

#endif // DIG_ESTIMATOR_APPROACH_APPROACHES_H
