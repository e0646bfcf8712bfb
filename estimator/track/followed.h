// What was told of a dig while it went on, kept for its end. A load that is lifted off the path
// belongs to the path measured, which then is none of the table's: that the dig was given up, and
// where, only the path before still says.

#ifndef DIG_ESTIMATOR_TRACK_FOLLOWED_H
#define DIG_ESTIMATOR_TRACK_FOLLOWED_H

#include "estimator/track/path.h"
#include "estimator/track/route.h"

#include <stdbool.h>
#include <stdint.h>

/// Zeroed: nothing was told.
struct dig_followed {
    bool    any;        // it was told to be along
    int     trajectory; // this one, and was at
    double  progress;   // this place when it was last near it;
    double  way_m;      // its own path was so long then
    bool    left;       // since then it is not on it any more
    bool    missing;    // samples were, for too long: where it was then no one knows
    int64_t last_ns;    // of the newest sample
};

/// A sample of the dig going on, or, not open, in the air before it. hole_s: longer without one is
/// missing.
void dig_followed_sample(struct dig_followed *followed, bool open, int64_t time_ns, double hole_s);

/// It is told to be along the trajectory, at progress, off_path_m from it. Within half of limit_m
/// is near; farther than limit_m is not on it.
void dig_followed_on(struct dig_followed *followed, int trajectory, double progress,
                     double off_path_m, double limit_m, const struct dig_path *path);

/// It is told to be along none.
void dig_followed_off(struct dig_followed *followed);

/// Of a dig whose whole path is along none of the routes: whether it left the one it was told to
/// be along before the end of that. What was told too soon is found out: the path up to where it
/// left must fit that route within limit_m, and better by tie_m than any other. As long as fitting
/// a whole path.
bool dig_followed_was_aborted(const struct dig_followed *followed, size_t routes,
                              const struct dig_route route[], const struct dig_path *path,
                              double limit_m, double tie_m);

#endif // DIG_ESTIMATOR_TRACK_FOLLOWED_H
