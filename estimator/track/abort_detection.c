#include "estimator/track/abort_detection.h"

#include "estimator/track/ending.h"

#include <assert.h>
#include <math.h>

// The path may have left after any of so many parts. The latest one that fits is taken, as the
// longest fit locates it best.
enum { PARTS = 8, FIRST_PART = 2 };

// A vertex within this share of limit_m is on the route; the last one within the wider share tells
// where the path left.
static const double on_share   = 0.25;
static const double left_share = 0.5;

// The part before the abort must fit better than the whole by this factor.
static const double better = 0.5;

// A path whose whole fits within this share of limit_m was not aborted.
static const double well_share = 0.0625;

// Cosine below which the way out turns off: 45 degrees.
static const double ahead_share = 0.7;

// The direction of the path is that over so many vertices.
enum { DIRECTION_VERTICES = 4 };

// Projects a vertex on what was left to dig at progress from.
static struct dig_projection project(const struct dig_route *const route,
                                     const struct dig_track *const track,
                                     const struct dig_path *const path, const size_t vertex,
                                     const double from)
{
    const struct dig_path_point at = dig_track_turned(track, &path->vertex[vertex]);
    return dig_route_project(route, track->dx_m, track->dz_m, &at, from, 1.0);
}

// Whether a vertex lies straight ahead of another, in the direction the path came from.
static bool is_ahead(const struct dig_path *const path, const size_t vertex, const size_t of)
{
    const size_t                before = of >= DIRECTION_VERTICES ? of - DIRECTION_VERTICES : 0;
    const struct dig_path_point came   = dig_path_point_sub(path->vertex[of], path->vertex[before]);
    const struct dig_path_point goes   = dig_path_point_sub(path->vertex[vertex], path->vertex[of]);
    const double length_m2 = dig_path_point_dot(came, came) * dig_path_point_dot(goes, goes);
    return dig_path_point_dot(came, goes) > ahead_share * sqrt(length_m2);
}

// Follows the path beyond the fitted part: whether it leaves the route, and where.
static bool leaves(const struct dig_route *const route, const struct dig_path *const path,
                   const double limit_m, struct dig_abort_detection *const d)
{
    size_t on      = d->until - 1; // last vertex on the route
    size_t near    = on;           // last one within limit_m of what was left then
    d->progress    = d->track.progress;
    double reached = d->progress;
    for (size_t i = d->until; i < path->end; i++) {
        const struct dig_projection place = project(route, &d->track, path, i, reached);
        if (place.distance_m <= on_share * limit_m) {
            on      = i;
            reached = fmax(reached, place.progress);
        }
        if (place.distance_m <= left_share * limit_m) {
            d->progress = fmax(d->progress, place.progress);
        }
        near = place.distance_m <= limit_m ? i : near;
    }
    return near + 1 < path->end && reached >= DIG_ENDING_LEAST && reached < DIG_ENDING_WHOLE_FROM &&
           !is_ahead(path, near + 1, on);
}

bool dig_abort_detection_find(const struct dig_route *const route,
                              const struct dig_path *const path, const double limit_m,
                              const struct dig_track *const     whole,
                              struct dig_abort_detection *const aborted)
{
    assert(route != NULL && path != NULL && whole != NULL && aborted != NULL);
    const double    length_m = route->at_m[route->corners - 1];
    const double    known    = (route->at_m[1] + limit_m) / length_m;
    struct dig_path until    = *path;
    if (whole->rms_m <= well_share * limit_m) {
        return false;
    }
    for (size_t part = PARTS - 1; part >= FIRST_PART; part--) {
        until.end = path->contact + part * (path->end - path->contact) / PARTS;
        if (until.end <= until.contact) {
            return false;
        }
        struct dig_abort_detection d = { .track = dig_track_fit(route, &until, limit_m),
                                         .until = until.end };
        const bool fits = d.track.rms_m <= fmin(on_share * limit_m, better * whole->rms_m) &&
                          d.track.progress >= known;
        if (fits && leaves(route, path, limit_m, &d)) {
            *aborted = d;
            return true;
        }
    }
    return false;
}

int dig_abort_detection_choose(const size_t routes, const struct dig_route route[],
                               const struct dig_path *const path, const double limit_m,
                               const struct dig_track            whole[],
                               struct dig_abort_detection *const aborted)
{
    assert(aborted != NULL);
    for (size_t r = 0; r < routes; r++) {
        struct dig_abort_detection d;
        if (!dig_abort_detection_find(&route[r], path, limit_m, &whole[r], &d)) {
            continue;
        }
        struct dig_track fitted[DIG_TRAJECTORY_MAX];
        struct dig_path  until = *path;
        until.end              = d.until;
        if (dig_track_fit_all(routes, route, &until, limit_m, fitted) == (int)r) {
            *aborted = d;
            return (int)r;
        }
    }
    return -1;
}
