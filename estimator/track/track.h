// Which trajectory of the table a bucket is on, and how far along.
//
// Where the ground lies and where the dig began is not known, so a trajectory fits up to a shift
// (dx, dz). theta is absolute and needs none, unless the table was dug with the bucket turned, too:
// then the turn is fitted within what it was dug at, by the same steps.
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

/// Two trajectories whose fits differ by less than this share of path_limit_m cannot be told apart.
#define DIG_TRACK_TIE_SHARE 0.125

/// How a route fits the vertices.
struct dig_track {
    double dx_m, dz_m;
    double turn_m; // by how much the bucket stands otherwise, within the route's range
    double anchor_dx_m, anchor_dz_m; // the shift that puts the contact at the start
    double rms_m;   // of the vertices from contact to end, NaN until fitted; those past the route's
                    // end count limit_m at most. What trajectories are compared by
    double score_m; // that, the vertices just before contact and a twentieth of the shift from the
                    // anchor, in quadrature. What shifts of one trajectory are compared by
    double progress; // of the last vertex
};

/// A point as the route has it: the turn taken off.
static inline struct dig_path_point dig_track_turned(const struct dig_track      *track,
                                                     const struct dig_path_point *point)
{
    return (struct dig_path_point){ point->x_m, point->z_m, point->turn_m - track->turn_m };
}

/// A track kept up to date while the dig goes on, and a second fit from another start that replaces
/// it when it turns out better: a Gauss-Newton fit alone can be caught at a wrong leg.
struct dig_follower {
    struct dig_track track, challenger;
    unsigned         turn;
};

/// A follower at its first fit, and one step of it: two refinements.
struct dig_follower dig_follower_start(const struct dig_route *route, const struct dig_path *path,
                                       double limit_m);
void dig_follower_step(const struct dig_route *route, const struct dig_path *path, double limit_m,
                       struct dig_follower *follower);

/// Fits from several starts, as contact may have been noticed late, and keeps the best.
/// O(vertices * corners), some hundred microseconds.
struct dig_track dig_track_fit(const struct dig_route *route, const struct dig_path *path,
                               double limit_m);

/// The track that fits best, or -1 when none is within limit_m or the best two cannot be told apart
/// (their rms differ by less than tie_m). sitting: the choice so far, or -1; kept while it is
/// tied.
int dig_track_choose(size_t tracks, const struct dig_track *const track[], double limit_m,
                     double tie_m, int sitting);

/// What is told of a choice that is made anew every tick.
struct dig_choice {
    int    current;   // the trajectory accepted; -1: not known
    int    candidate; // of the last tick
    size_t held;      // ticks it has been that
};

/// Tells a new choice once it has held for 24 steps of every track's follower, one follower a tick
/// (0.36 s of three at 200 Hz); until then the old one. Returns what is told.
int dig_choice_step(struct dig_choice *choice, size_t tracks, int chosen);

#endif // DIG_ESTIMATOR_TRACK_TRACK_H
