// Routes of a trajectory at other depths and attacks. A turned bucket shifts the route in its third
// coordinate; another depth makes the first leg longer or shorter. Also the depth of a dig.

#ifndef DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H
#define DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H

#include "core/curve.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"

/// The route of the plain trajectory, with the range of turns the table was dug at.
struct dig_route dig_approach_route(const struct dig_curve_set *set, size_t trajectory);

/// The route at another depth. Its later legs are those of the plain one: a track fitted to the
/// plain route holds for it.
struct dig_route dig_approach_route_deep(const struct dig_curve_set *set, size_t trajectory,
                                         double depth);

/// A rough depth of a dig, by where the soil began to resist: the path from there to the end of the
/// first leg, against that of the table's digs at several depths and attacks. The moment is over
/// the path of dig_approach_route_deep() at deepest, measured from first to last. Resistance begins
/// at a quarter and at a half of the moment just behind the first leg; the mean of the two counts,
/// over all gravels of the table. 1 where the table was dug at one depth, or too little of the path
/// was measured. Scatter of one dig makes it uncertain by about two thirds of a grain.
double dig_approach_depth(const struct dig_curve_set *set, size_t trajectory, double deepest,
                          double attack_rad, double first, double last,
                          const double moment_Nm[DIG_CURVE_POINTS]);

/// The depths the table was dug at along the trajectory, 1 among them.
struct dig_depths {
    double least, most;
};
struct dig_depths dig_approach_depths(const struct dig_curve_set *set, size_t trajectory);

#endif // DIG_ESTIMATOR_APPROACH_APPROACH_ROUTE_H
