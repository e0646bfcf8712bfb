// The trajectory that a dig followed while it was in progress, kept for its end. When a load is
// lifted off the path, the whole path fits no trajectory; only the part before shows that the dig
// was aborted, and where.

#ifndef DIG_ESTIMATOR_TRACK_FOLLOWED_H
#define DIG_ESTIMATOR_TRACK_FOLLOWED_H

#include "estimator/track/path.h"
#include "estimator/track/route.h"

#include <stdbool.h>
#include <stdint.h>

/// Zeroed: no trajectory was followed.
struct dig_followed {
    bool    any;        // a trajectory was followed
    int     trajectory; // the last one
    double  progress;   // where the dig was last near it
    double  path_m;     // length of the dig's path then
    bool    left;       // the dig has left it since
    bool    missing;    // samples were missing for too long: the path has a hole
    int64_t last_ns;    // time of the newest sample
};

/// Adds the time of a sample; open: of a dig in progress, else in the air before it. A gap longer
/// than hole_s sets missing.
void dig_followed_sample(struct dig_followed *followed, bool open, int64_t time_ns, double hole_s);

/// The dig is along the trajectory, off_path_m from it: near within half of limit_m; beyond limit_m
/// it has left.
void dig_followed_on(struct dig_followed *followed, int trajectory, double progress,
                     double off_path_m, double limit_m, const struct dig_path *path);

/// The dig is along no trajectory.
void dig_followed_off(struct dig_followed *followed);

/// For a dig whose whole path fits no route: whether it left the followed one before its end. A
/// trajectory chosen too soon does not count: the path up to where it left must fit the route
/// within limit_m, and better than any other (dig_track_choose()). Costs as much as fitting a whole
/// path.
bool dig_followed_was_aborted(const struct dig_followed *followed, size_t routes,
                              const struct dig_route route[], const struct dig_path *path,
                              double limit_m);

#endif // DIG_ESTIMATOR_TRACK_FOLLOWED_H
