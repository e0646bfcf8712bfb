#include "estimator/track/track.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

// Weight of the prior on the shift, in vertices: (scatter of one vertex / 1 sigma of the distance
// from the start of the route at which contact is detected)^2.
static const double anchor_weight = 2.5e-3;

// Before contact the bucket may come from anywhere: only vertices this near the route count, in
// limit_m. A fit starts with the wider share, to follow a leg dug before contact was detected.
static const double lead_in_share = 0.1;
static const double wide_in_share = 0.5;

// Share of the shift from the anchor that counts in the score: contact is detected late, but a fit
// that needs it very late is worse than one that does not.
static const double anchor_share = 0.05;

// Vertices before contact that count in the score, limit_m each at most: they are likely to lie on
// the route too, but may be air.
enum { LEAD_VERTICES = 16 };

// Turns of every follower for which a choice must hold before it is accepted.
enum { CHOICE_TURNS = 24 };

// Fits start from contact at these places of the route; steps of one fit.
enum { STARTS = 8, CHALLENGE_STEPS = 6 };
static const double start_step = 0.05;

// A vertex is projected from this far behind to this far ahead of the last one's progress.
static const double look_behind = 0.10;
static const double look_ahead  = 0.35;

static struct dig_track track_start(const struct dig_route *const route,
                                    const struct dig_path *const path, const double start)
{
    assert(route != NULL && path != NULL && path->contact < path->end);
    const struct dig_path_point *const touched = &path->vertex[path->contact];
    const struct dig_path_point        place   = dig_route_point(route, start);
    return (struct dig_track){
        .dx_m        = touched->x_m - place.x_m,
        .dz_m        = touched->z_m - place.z_m,
        .anchor_dx_m = touched->x_m - route->corner[0].x_m,
        .anchor_dz_m = touched->z_m - route->corner[0].z_m,
        .rms_m       = NAN,
        .score_m     = NAN,
    };
}

// Normal equations of the shift, symmetric, and of the turn where the route has a range of it.
struct normal {
    double xx, xz, zz, bx, bz;
    double xt, zt, tt, bt;
};

static void add_equation(struct normal *const normal, const struct dig_projection *const place)
{
    const struct dig_path_point t = place->tangent;
    normal->xx += 1.0 - t.x_m * t.x_m;
    normal->xz -= t.x_m * t.z_m;
    normal->zz += 1.0 - t.z_m * t.z_m;
    normal->bx += place->off.x_m;
    normal->bz += place->off.z_m;
    normal->xt -= t.x_m * t.turn_m;
    normal->zt -= t.z_m * t.turn_m;
    normal->tt += 1.0 - t.turn_m * t.turn_m;
    normal->bt += place->off.turn_m;
}

// Steps the turn, and eliminates it from the equations of the shift.
static void turn(const struct dig_route *const route, struct normal *const n,
                 struct dig_track *const track)
{
    if (!(route->turn_most_m > route->turn_least_m)) {
        return;
    }
    // The turn's equation with the shift eliminated.
    const double det  = n->xx * n->zz - n->xz * n->xz;
    const double px   = (n->zz * n->xt - n->xz * n->zt) / det;
    const double pz   = (n->xx * n->zt - n->xz * n->xt) / det;
    const double left = n->tt - n->xt * px - n->zt * pz;
    const double by   = (n->bt - n->bx * px - n->bz * pz) / left;
    const double to   = fmin(fmax(track->turn_m + by, route->turn_least_m), route->turn_most_m);
    n->bx -= n->xt * (to - track->turn_m);
    n->bz -= n->zt * (to - track->turn_m);
    track->turn_m = to;
}

static void refine(const struct dig_route *const route, const struct dig_path *const path,
                   const double limit_m, const double lead_in_m, struct dig_track *const track)
{
    assert(route != NULL && path != NULL && track != NULL && path->contact < path->end);

    // A weak prior: contact was at the start.
    struct normal normal = {
        .xx = anchor_weight,
        .zz = anchor_weight,
        .bx = anchor_weight * (track->anchor_dx_m - track->dx_m),
        .bz = anchor_weight * (track->anchor_dz_m - track->dz_m),
        .tt = anchor_weight,
        .bt = -anchor_weight * track->turn_m,
    };
    double lead_m2 = 0.0;
    double sum_m2  = 0.0;
    double last    = 0.0;
    for (size_t i = 0; i < path->end; i++) {
        const double                from = last - look_behind;
        const double                to   = last + look_ahead;
        const struct dig_path_point at   = dig_track_turned(track, &path->vertex[i]);
        const struct dig_projection place =
            dig_route_project(route, track->dx_m, track->dz_m, &at, from, fmin(to, 1.0));

        if (i < path->contact) {
            if (i + LEAD_VERTICES >= path->contact) {
                lead_m2 += pow(fmin(place.distance_m, limit_m), 2.0);
            }
            if (place.distance_m < lead_in_m) {
                add_equation(&normal, &place);
                last = place.progress;
            }
            continue;
        }

        // Past the route's end a vertex does not constrain the shift, but its distance counts.
        const bool past = place.progress >= 1.0 && last >= 1.0 - look_behind;
        if (past) {
            sum_m2 += pow(fmin(place.distance_m, limit_m), 2.0);
        } else {
            add_equation(&normal, &place);
            sum_m2 += place.distance_m * place.distance_m;
        }
        last = place.progress;
    }

    turn(route, &normal, track);
    const double det = normal.xx * normal.zz - normal.xz * normal.xz;
    track->dx_m += (normal.zz * normal.bx - normal.xz * normal.bz) / det;
    track->dz_m += (normal.xx * normal.bz - normal.xz * normal.bx) / det;

    const double whole = (double)(path->end - path->contact);
    const double anchor =
        anchor_share * hypot(track->anchor_dx_m - track->dx_m, track->anchor_dz_m - track->dz_m);

    track->rms_m    = sqrt(sum_m2 / whole);
    track->score_m  = hypot(sqrt((lead_m2 + sum_m2) / whole), anchor);
    track->progress = last;
}

// The share of vertices before contact, by step of a new fit.
static double lead_in_m(const unsigned step, const double limit_m)
{
    return (step < CHALLENGE_STEPS / 2 ? wide_in_share : lead_in_share) * limit_m;
}

static void step_track(const struct dig_route *const route, const struct dig_path *const path,
                       const double limit_m, struct dig_track *const track)
{
    refine(route, path, limit_m, lead_in_share * limit_m, track);
}

struct dig_follower dig_follower_start(const struct dig_route *const route,
                                       const struct dig_path *const path, const double limit_m)
{
    struct dig_follower follower = { .track = track_start(route, path, 0.0) };
    step_track(route, path, limit_m, &follower.track);
    return follower;
}

void dig_follower_step(const struct dig_route *const route, const struct dig_path *const path,
                       const double limit_m, struct dig_follower *const follower)
{
    assert(follower != NULL);
    struct dig_track *const track      = &follower->track;
    struct dig_track *const challenger = &follower->challenger;
    step_track(route, path, limit_m, track);

    if (follower->turn % CHALLENGE_STEPS == 0) {
        const double start = start_step * (double)(follower->turn / CHALLENGE_STEPS % STARTS);
        *challenger        = track_start(route, path, start);
    }
    const unsigned step = follower->turn % CHALLENGE_STEPS;
    refine(route, path, limit_m, lead_in_m(step, limit_m), challenger);
    follower->turn++;
    if (follower->turn % CHALLENGE_STEPS == 0 && challenger->score_m < track->score_m) {
        *track = *challenger;
    }
}

struct dig_track dig_track_fit(const struct dig_route *const route,
                               const struct dig_path *const path, const double limit_m)
{
    struct dig_track best = { .score_m = INFINITY };
    for (size_t k = 0; k < STARTS; k++) {
        struct dig_track track = track_start(route, path, start_step * (double)k);
        for (unsigned step = 0; step < CHALLENGE_STEPS; step++) {
            refine(route, path, limit_m, lead_in_m(step, limit_m), &track);
        }
        best = track.score_m < best.score_m ? track : best;
    }
    for (unsigned step = 0; step < CHALLENGE_STEPS; step++) {
        step_track(route, path, limit_m, &best);
    }
    return best;
}

int dig_choice_step(struct dig_choice *const choice, const size_t tracks, const int chosen)
{
    assert(choice != NULL);
    choice->held      = chosen == choice->candidate ? choice->held + 1 : 0;
    choice->candidate = chosen;
    if (choice->held >= tracks * CHOICE_TURNS) {
        choice->current = chosen;
    }
    return choice->current;
}

int dig_track_choose(const size_t tracks, const struct dig_track *const track[],
                     const double limit_m, const int current)
{
    const double tie_m    = DIG_TRACK_TIE_SHARE * limit_m;
    int          best     = -1;
    double       best_m   = INFINITY;
    double       second_m = INFINITY;
    for (size_t t = 0; t < tracks; t++) {
        if (track[t]->rms_m < best_m) {
            second_m = best_m;
            best_m   = track[t]->rms_m;
            best     = (int)t;
        } else if (track[t]->rms_m < second_m) {
            second_m = track[t]->rms_m;
        }
    }
    if (best < 0 || !(track[best]->rms_m <= limit_m)) {
        return -1;
    }
    if (second_m - best_m >= tie_m) {
        return best;
    }
    return current >= 0 && track[current]->rms_m - best_m < tie_m ? current : -1;
}

int dig_track_fit_all(const size_t routes, const struct dig_route route[],
                      const struct dig_path *const path, const double limit_m,
                      struct dig_track fitted[])
{
    assert(routes <= DIG_TRAJECTORY_MAX && (routes == 0 || fitted != NULL));
    const struct dig_track *track_of[DIG_TRAJECTORY_MAX];
    for (size_t r = 0; r < routes; r++) {
        fitted[r]   = dig_track_fit(&route[r], path, limit_m);
        track_of[r] = &fitted[r];
    }
    return dig_track_choose(routes, track_of, limit_m, -1);
}
