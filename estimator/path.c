#include "estimator/path.h"

#include <assert.h>
#include <math.h>

// How far from the start of the route contact may be noticed, 1 sigma, against the scatter of one
// vertex: what the prior on the shift weighs, in vertices.
static const double anchor_weight = 2.5e-3;

// Before contact the bucket may come from anywhere: in the end only vertices this near count, in
// limit_m. A fit begins with more, to be drawn along a leg dug before contact was felt.
static const double lead_in_share = 0.1;
static const double wide_in_share = 0.5;

// What a contact far from the start of the route counts as, in distance: contact is noticed late,
// but a fit that needs it very late is worse than one that does not.
static const double anchor_share = 0.05;

// The last vertices before contact are likely to lie on the route too: contact is noticed late.
// What does not counts this much, and never more than limit_m; it may still have been air.
enum { LEAD_VERTICES = 16 };

// Turns of every follower for which a choice must hold before it is told.
enum { CHOICE_TURNS = 24 };

// Places of the route where contact may have been noticed, late as it is: where fits start from.
enum { STARTS = 8, CHALLENGE_STEPS = 6 };
static const double start_step = 0.05;

// A vertex is looked for this far behind and ahead of the last one's place.
static const double look_behind = 0.10;
static const double look_ahead  = 0.35;

static double dot(const struct dig_path_point a, const struct dig_path_point b)
{
    return a.x_m * b.x_m + a.z_m * b.z_m + a.turn_m * b.turn_m;
}

static struct dig_path_point minus(const struct dig_path_point a, const struct dig_path_point b)
{
    return (struct dig_path_point){ a.x_m - b.x_m, a.z_m - b.z_m, a.turn_m - b.turn_m };
}

static struct dig_path_point scaled(const struct dig_path_point a, const double s)
{
    return (struct dig_path_point){ s * a.x_m, s * a.z_m, s * a.turn_m };
}

struct dig_route dig_route_make(const struct dig_trajectory *const trajectory, const double tooth_m)
{
    assert(trajectory != NULL && trajectory->phases <= DIG_PHASES_MAX);
    struct dig_route route  = { .corners = trajectory->phases + 1 };
    double           time_s = 0.0;
    for (size_t i = 0; i <= trajectory->phases; i++) {
        const struct dig_pose pose = dig_trajectory_pose(trajectory, time_s);
        route.corner[i] = (struct dig_path_point){ pose.x_m, pose.z_m, tooth_m * pose.theta_rad };
        route.at_m[i]   = dig_trajectory_path_m(trajectory, tooth_m, time_s);
        time_s += i < trajectory->phases ? trajectory->phase[i].duration_s : 0.0;
    }
    return route;
}

struct dig_place dig_route_place(const struct dig_route *const route, const double dx_m,
                                 const double dz_m, const struct dig_path_point *const point,
                                 const double from, const double to)
{
    assert(route != NULL && point != NULL && route->corners >= 2);
    const double                whole_m = route->at_m[route->corners - 1];
    const double                from_m  = from * whole_m;
    const double                to_m    = to * whole_m;
    const struct dig_path_point at      = { point->x_m - dx_m, point->z_m - dz_m, point->turn_m };

    struct dig_place best = { .distance_m = INFINITY };
    for (size_t i = 0; i + 1 < route->corners; i++) {
        const double length_m = route->at_m[i + 1] - route->at_m[i];
        if (!(length_m > 0.0) || route->at_m[i + 1] < from_m || route->at_m[i] > to_m) {
            continue;
        }
        const struct dig_path_point leg     = minus(route->corner[i + 1], route->corner[i]);
        const struct dig_path_point rel     = minus(at, route->corner[i]);
        const double                leg2    = dot(leg, leg);
        const double                free_f  = dot(rel, leg) / leg2;
        const double                low_f   = fmax((from_m - route->at_m[i]) / length_m, 0.0);
        const double                high_f  = fmin((to_m - route->at_m[i]) / length_m, 1.0);
        const double                f       = fmin(fmax(free_f, low_f), high_f);
        const bool                  is_lead = i == 0 && free_f < 0.0 && low_f <= 0.0;

        // On the lead-in the foot lies before the start, where progress is still 0.
        const struct dig_path_point off = minus(rel, scaled(leg, is_lead ? free_f : f));
        const double                d_m = sqrt(dot(off, off));
        if (d_m < best.distance_m) {
            const bool inside = is_lead || (free_f > 0.0 && free_f < 1.0);
            best              = (struct dig_place){
                             .progress   = (route->at_m[i] + f * length_m) / whole_m,
                             .distance_m = d_m,
                             .tangent    = inside ? scaled(leg, 1.0 / sqrt(leg2)) : (struct dig_path_point){ 0 },
                             .off        = off,
            };
        }
    }
    return best;
}

// Keeps every other vertex and doubles the spacing.
static void thin(struct dig_path *const path)
{
    size_t kept = 0;
    for (size_t i = 0; i < path->vertices; i += 2) {
        path->vertex[kept++] = path->vertex[i];
    }
    path->vertices = kept;
    path->contact /= 2;
    path->end = (path->end + 1) / 2;
    path->spacing_m *= 2.0;
}

static void append(struct dig_path *const path, const struct dig_path_point *const point)
{
    if (path->vertices == DIG_PATH_MAX) {
        thin(path);
    }
    path->vertex[path->vertices++] = *point;
}

bool dig_path_add(struct dig_path *const path, const struct dig_path_point *const point,
                  const bool in_soil)
{
    assert(path != NULL && point != NULL && path->spacing_m > 0.0);
    bool away = true;
    if (path->vertices > 0) {
        const struct dig_path_point step = minus(*point, path->vertex[path->vertices - 1]);
        away                             = dot(step, step) >= path->spacing_m * path->spacing_m;
    }
    if (away) {
        append(path, point);
    }
    if (in_soil) {
        path->end = path->vertices;
    }
    return away;
}

void dig_path_touch(struct dig_path *const path, const struct dig_path_point *const point)
{
    assert(path != NULL && point != NULL);
    append(path, point);
    path->contact = path->vertices - 1;
    path->end     = path->vertices;
}

static struct dig_path_point route_at(const struct dig_route *const route, const double progress)
{
    const double at_m = progress * route->at_m[route->corners - 1];
    size_t       i    = 0;
    while (i + 2 < route->corners && route->at_m[i + 1] <= at_m) {
        i++;
    }
    const double                length_m = route->at_m[i + 1] - route->at_m[i];
    const double                f   = length_m > 0.0 ? (at_m - route->at_m[i]) / length_m : 0.0;
    const struct dig_path_point leg = minus(route->corner[i + 1], route->corner[i]);
    return minus(route->corner[i], scaled(leg, -f));
}

struct dig_track dig_track_start(const struct dig_route *const route,
                                 const struct dig_path *const path, const double start)
{
    assert(route != NULL && path != NULL && path->contact < path->end);
    const struct dig_path_point *const touched = &path->vertex[path->contact];
    const struct dig_path_point        place   = route_at(route, start);
    return (struct dig_track){
        .dx_m        = touched->x_m - place.x_m,
        .dz_m        = touched->z_m - place.z_m,
        .anchor_dx_m = touched->x_m - route->corner[0].x_m,
        .anchor_dz_m = touched->z_m - route->corner[0].z_m,
        .rms_m       = NAN,
        .score_m     = NAN,
    };
}

// Normal equations of the shift: 2 x 2, symmetric.
struct normal {
    double xx, xz, zz, bx, bz;
};

static void add_equation(struct normal *const normal, const struct dig_place *const place)
{
    const struct dig_path_point t = place->tangent;
    normal->xx += 1.0 - t.x_m * t.x_m;
    normal->xz -= t.x_m * t.z_m;
    normal->zz += 1.0 - t.z_m * t.z_m;
    normal->bx += place->off.x_m;
    normal->bz += place->off.z_m;
}

static void refine(const struct dig_route *const route, const struct dig_path *const path,
                   const double limit_m, const double lead_in_m, struct dig_track *const track)
{
    assert(route != NULL && path != NULL && track != NULL && path->contact < path->end);

    // The anchor pulls weakly towards "contact was at the start".
    struct normal normal = {
        .xx = anchor_weight,
        .zz = anchor_weight,
        .bx = anchor_weight * (track->anchor_dx_m - track->dx_m),
        .bz = anchor_weight * (track->anchor_dz_m - track->dz_m),
    };
    double lead_m2 = 0.0;
    double sum_m2  = 0.0;
    double last    = 0.0;
    for (size_t i = 0; i < path->end; i++) {
        const double           from = last - look_behind;
        const double           to   = last + look_ahead;
        const struct dig_place place =
            dig_route_place(route, track->dx_m, track->dz_m, &path->vertex[i], from, fmin(to, 1.0));

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

        // Past its end the route says nothing about the shift, but a bucket far off it is a miss.
        const bool past = place.progress >= 1.0 && last >= 1.0 - look_behind;
        if (past) {
            sum_m2 += pow(fmin(place.distance_m, limit_m), 2.0);
        } else {
            add_equation(&normal, &place);
            sum_m2 += place.distance_m * place.distance_m;
        }
        last = place.progress;
    }

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

// How near vertices before contact must lie to count in this step of a new fit.
static double lead_in_m(const unsigned step, const double limit_m)
{
    return (step < CHALLENGE_STEPS / 2 ? wide_in_share : lead_in_share) * limit_m;
}

void dig_track_refine(const struct dig_route *const route, const struct dig_path *const path,
                      const double limit_m, struct dig_track *const track)
{
    refine(route, path, limit_m, lead_in_share * limit_m, track);
}

struct dig_follower dig_follower_start(const struct dig_route *const route,
                                       const struct dig_path *const path, const double limit_m)
{
    struct dig_follower follower = { .track = dig_track_start(route, path, 0.0) };
    dig_track_refine(route, path, limit_m, &follower.track);
    return follower;
}

void dig_follower_step(const struct dig_route *const route, const struct dig_path *const path,
                       const double limit_m, struct dig_follower *const follower)
{
    assert(follower != NULL);
    struct dig_track *const track      = &follower->track;
    struct dig_track *const challenger = &follower->challenger;
    dig_track_refine(route, path, limit_m, track);

    if (follower->turn % CHALLENGE_STEPS == 0) {
        const double start = start_step * (double)(follower->turn / CHALLENGE_STEPS % STARTS);
        *challenger        = dig_track_start(route, path, start);
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
        struct dig_track track = dig_track_start(route, path, start_step * (double)k);
        for (unsigned step = 0; step < CHALLENGE_STEPS; step++) {
            refine(route, path, limit_m, lead_in_m(step, limit_m), &track);
        }
        best = track.score_m < best.score_m ? track : best;
    }
    for (unsigned step = 0; step < CHALLENGE_STEPS; step++) {
        dig_track_refine(route, path, limit_m, &best);
    }
    return best;
}

int dig_choice_step(struct dig_choice *const choice, const size_t tracks, const int chosen)
{
    assert(choice != NULL);
    choice->held      = chosen == choice->candidate ? choice->held + 1 : 0;
    choice->candidate = chosen;
    if (choice->held >= tracks * CHOICE_TURNS) {
        choice->told = chosen;
    }
    return choice->told;
}

int dig_track_choose(const size_t tracks, const struct dig_track *const track[],
                     const double limit_m, const double tie_m, const int sitting)
{
    int    best     = -1;
    double best_m   = INFINITY;
    double second_m = INFINITY;
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
    return sitting >= 0 && track[sitting]->rms_m - best_m < tie_m ? sitting : -1;
}
