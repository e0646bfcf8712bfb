// Tracking: the trajectory of the table the bucket follows, and the progress along it.
//
// Where the ground lies and where the dig began is not known, so a trajectory is fitted with a
// shift (dx, dz). theta is absolute; if the table was also dug with the bucket turned, a turn
// within that range is fitted by the same steps.
//
//     measured vertices     o  o                     shift: Gauss-Newton on the distances from
//                          o    \                    vertices to the polyline (normal to it only,
//     trajectory   ---------     o  o  o  o          so a straight leg says nothing along itself)
//       + shift               `--------------
//
// Along a first straight leg the shift is held by a weak prior: contact was near the start.

#ifndef DIG_ESTIMATOR_TRACK_TRACK_H
#define DIG_ESTIMATOR_TRACK_TRACK_H

#include "estimator/track/path.h"
#include "estimator/track/route.h"

#include <stddef.h>

/// Two trajectories whose fits differ by less than this share of path_limit_m are tied: noise of
/// the angles makes such differences.
#define DIG_TRACK_TIE_SHARE 0.125

/// How a route fits the vertices.
struct dig_track {
    double dx_m, dz_m;
    double turn_m; // of the bucket against the trajectory, within the route's range
    double anchor_dx_m, anchor_dz_m; // the shift that puts the contact at the start
    double rms_m;   // of the vertices from contact to end, NaN until fitted; those past the route's
                    // end count limit_m at most. Compares trajectories
    double score_m; // rms_m, the vertices just before contact and a twentieth of the shift from the
                    // anchor, in quadrature. Compares shifts of one trajectory
    double progress; // of the last vertex
};

/// A point with the track's turn subtracted.
static inline struct dig_path_point dig_track_turned(const struct dig_track      *track,
                                                     const struct dig_path_point *point)
{
    return (struct dig_path_point){ point->x_m, point->z_m, point->turn_m - track->turn_m };
}

/// A track refined while the dig is in progress, and a challenger: a second fit from another start,
/// which replaces it when it is better. A single Gauss-Newton fit can converge on a wrong leg.
struct dig_follower {
    struct dig_track track, challenger;
    unsigned         turn;
};

/// Starts a follower at its first fit; steps it by two refinements.
struct dig_follower dig_follower_start(const struct dig_route *route, const struct dig_path *path,
                                       double limit_m);
void dig_follower_step(const struct dig_route *route, const struct dig_path *path, double limit_m,
                       struct dig_follower *follower);

/// Fits from several starts, as contact may be detected late, and returns the best.
/// O(vertices * corners), some hundred microseconds.
struct dig_track dig_track_fit(const struct dig_route *route, const struct dig_path *path,
                               double limit_m);

/// The track that fits best; -1 when none is within limit_m, or the best two are tied. current: the
/// choice so far, kept while it is tied; or -1.
int dig_track_choose(size_t tracks, const struct dig_track *const track[], double limit_m,
                     int current);

/// Fits the path to every route, and chooses among the fits. Some hundred microseconds a route.
int dig_track_fit_all(size_t routes, const struct dig_route route[], const struct dig_path *path,
                      double limit_m, struct dig_track fitted[]);

/// The choice among the tracks, debounced: it is made anew every tick.
struct dig_choice {
    int    current;   // the trajectory accepted; -1: not known
    int    candidate; // of the last tick
    size_t held;      // ticks the candidate has held
};

/// Accepts a new choice once it has held for 24 steps of every track's follower, one follower a
/// tick (0.36 s for three at 200 Hz). Returns the current choice.
int dig_choice_step(struct dig_choice *choice, size_t tracks, int chosen);

#endif // DIG_ESTIMATOR_TRACK_TRACK_H
