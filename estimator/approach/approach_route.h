// A trajectory of a table as a route, with what the table's further digs allow: the bucket turned
// all along, which shifts the route in its third direction, and the first leg longer or shorter.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H

#include "core/approach.h"
#include "core/curve.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

/// The route of the plain trajectory; the bucket may be turned by what the table was dug at.
struct dig_route dig_approach_route(const struct dig_curve_set *set, size_t trajectory);

/// The route at another depth, its legs behind the first where those of the plain one are: a track
/// fitted to the plain route holds for it.
struct dig_route dig_approach_route_deep(const struct dig_curve_set *set, size_t trajectory,
                                         double depth);

/// How deep a dig was, by where its soil began to resist: the way from there to the end of the
/// first leg, against that of the table's own digs at several depths, and at several attacks. The
/// moment is over the path of dig_approach_route_deep() at deepest, measured from first to last.
/// Resisting begins at a quarter and at a half of the moment just behind the first leg; the mean of
/// the two counts, over all gravels of the table. 1 where the table was dug at one depth, or too
/// little of the way was measured to tell. The scatter of one dig makes it uncertain by about a
/// tenth.
double dig_approach_depth(const struct dig_curve_set *set, size_t trajectory, double deepest,
                          double attack_rad, double first, double last,
                          const double moment_Nm[DIG_CURVE_POINTS]);

/// The greatest depth the table was dug at along the trajectory, at least 1.
double dig_approach_deepest(const struct dig_curve_set *set, size_t trajectory);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H
