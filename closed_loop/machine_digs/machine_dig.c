#include "closed_loop/machine_digs/machine_dig.h"

#include "closed_loop/machine_digs/free_air.h"
#include "closed_loop/machine_digs/recording_faults.h"
#include "core/sample.h"
#include "estimator/approach/approach_route.h"
#include "estimator/track/frame.h"
#include "estimator/track/recorded_dig.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// In tooth lengths: spacing of the vertices, how far a path may lie off its trajectory (the
// estimator's path_limit_m on the rig), and how far off a start may be turned beyond its range.
static const double spacing_share = 0.025;
static const double limit_share   = 0.09;
static const double turned_share  = 0.12;

// Of its trajectory a recording may lack so much at its end, as one by force may (alignment.c), and
// so much at its beginning: farther on a window does not look for it. Looked for are more, in
// steps, so that one that lacks too much is refused as that.
static const double end_missing   = 0.3;
static const double begin_missing = 0.1;
static const double begin_step    = 0.05;
enum { BEGINNINGS = 8 };

// The ends of a dig are blended and may be cut: they do not tell its pace.
static const double blended_share = 0.05;

struct dig_path_point dig_machine_dig_point(const struct dig_curve_set *const   set,
                                            const struct dig_machine_dig *const dig,
                                            const struct dig_front *const       front)
{
    const struct dig_vec2 *const pin = &front->pin_m[DIG_JOINT_BUCKET];
    const struct dig_path_point  own = dig_recorded_dig_point(set, dig->lambda, pin->x, pin->y,
                                                              front->attitude_rad[DIG_JOINT_BUCKET]);
    return dig_frame_turned(&own, dig->frame_rad, set->tooth_m);
}

static struct dig_path_point point_of(const struct dig_machine *const     machine,
                                      const struct dig_curve_set *const   set,
                                      const struct dig_machine_dig *const dig, const size_t sample)
{
    const struct dig_front front =
        dig_front_place(machine, &dig->sample[sample].value[DIG_SIGNAL_BOOM_rad]);
    return dig_machine_dig_point(set, dig, &front);
}

// The path of the whole recording.
static void lay_out(const struct dig_machine *const machine, const struct dig_curve_set *const set,
                    const struct dig_machine_dig *const dig, struct dig_vertices *const v)
{
    const double spacing_m = spacing_share * set->tooth_m;
    v->count               = 0;
    for (size_t i = 0; i < dig->samples; i++) {
        const struct dig_path_point at = point_of(machine, set, dig, i);
        if (v->count > 0) {
            const struct dig_path_point step = dig_path_point_sub(at, v->point[v->count - 1]);
            if (dig_path_point_dot(step, step) < spacing_m * spacing_m) {
                continue;
            }
        }
        v->point[v->count]    = at;
        v->sample[v->count++] = i;
    }
}

// How far the bucket is turned at a point against one of the route's, within the route's range.
static double turn_at(const struct dig_route *const route, const struct dig_path_point *const at,
                      const struct dig_path_point *const begun)
{
    return fmin(fmax(at->turn_m - begun->turn_m, route->turn_least_m), route->turn_most_m);
}

// A dig along a trajectory.
struct found {
    double off_m; // rms, in which what is missing counts whole
    int    trajectory;
    size_t start, end;  // vertices
    double begin, last; // progress there
};

// How far the path from a vertex on lies off the route begun there at a progress, turned as there:
// rms, in which what is missing of the route counts whole, but for what the recording's end may
// take.
static void follow(const struct dig_route *const route, const struct dig_vertices *const v,
                   const double tooth_m, const double enough_m, struct found *const found)
{
    const size_t                start   = found->start;
    const double                whole_m = route->at_m[route->corners - 1];
    const size_t                most    = (size_t)(1.5 * whole_m / (spacing_share * tooth_m)) + 2;
    const struct dig_path_point from    = v->point[start];
    const struct dig_path_point begun   = dig_route_point(route, found->begin);
    const double                dx_m    = from.x_m - begun.x_m;
    const double                dz_m    = from.z_m - begun.z_m;

    const struct dig_track turned = { .turn_m = turn_at(route, &from, &begun) };
    double                 sum_m2 = 0.0;
    double                 last   = found->begin;
    size_t                 i      = start;
    for (; i < v->count && i < start + most && last < 0.99; i++) {
        const struct dig_path_point at = dig_track_turned(&turned, &v->point[i]);
        const struct dig_projection place =
            dig_route_project(route, dx_m, dz_m, &at, last - 0.02, fmin(last + 0.1, 1.0));
        sum_m2 += place.distance_m * place.distance_m;
        last = fmax(last, place.progress);
        if (sum_m2 > (double)most * enough_m * enough_m) {
            found->off_m = INFINITY;
            return;
        }
    }
    const double taken = i == v->count ? end_missing : 0.0;
    found->end         = i;
    found->last        = last;
    found->off_m       = sqrt(sum_m2 / (double)(i - start)) +
                   (last < 0.99 ? fmax(1.0 - last - taken, 0.0) * whole_m : 0.0);
}

// Tries one vertex as one place of a route.
static void try(const struct dig_curve_set *const set, const struct dig_vertices *const v,
                const struct dig_route *const route, struct found tried, struct found *const best)
{
    const struct dig_path_point begun  = dig_route_point(route, tried.begin);
    const double                turn_m = v->point[tried.start].turn_m - begun.turn_m;
    if (fabs(turn_m - turn_at(route, &v->point[tried.start], &begun)) <=
        turned_share * set->tooth_m) {
        follow(route, v, set->tooth_m, best->off_m, &tried);
        *best = tried.off_m < best->off_m ? tried : *best;
    }
}

// Tries every vertex as the start of every trajectory asked for, and the first as a place behind
// it.
static struct found search(const struct dig_curve_set *const set,
                           const struct dig_vertices *const v, const int asked)
{
    struct found best = { .off_m = INFINITY, .trajectory = -1 };
    for (size_t t = 0; t < set->trajectories; t++) {
        if (asked >= 0 && (size_t)asked != t) {
            continue;
        }
        const struct dig_route route = dig_approach_route(set, t);
        for (size_t s = 0; s + 2 < v->count; s++) {
            try(set, v, &route, (struct found){ .trajectory = (int)t, .start = s }, &best);
        }
        for (int k = 1; k <= BEGINNINGS && v->count > 2; k++) {
            const double begin = begin_step * (double)k;
            try(set, v, &route, (struct found){ .trajectory = (int)t, .begin = begin }, &best);
        }
    }
    return best;
}

struct dig_track dig_machine_dig_fit(const struct dig_curve_set *const   set,
                                     const struct dig_machine_dig *const dig, const size_t before,
                                     const size_t points, const struct dig_path_point point[])
{
    assert(set != NULL && dig != NULL && points > before && point != NULL);
    const struct dig_route route = dig_approach_route(set, (size_t)dig->trajectory);
    struct dig_path        path  = { .spacing_m = 0.5 * spacing_share * set->tooth_m };
    for (size_t i = 0; i < points; i++) {
        if (i == before) {
            dig_path_add_contact(&path, &point[i]);
        } else {
            (void)dig_path_add(&path, &point[i], i > before);
        }
    }
    return dig_track_fit(&route, &path, limit_share * set->tooth_m);
}

// middle_s: rig time from a progress to another.
static double pace_of(const struct dig_curve_set *const   set,
                      const struct dig_machine_dig *const dig, const double from, const double to,
                      const double middle_s)
{
    const struct dig_trajectory *const t = &set->trajectory[dig->trajectory];
    const double                       table_s =
        dig_trajectory_time_s(t, set->tooth_m, to) - dig_trajectory_time_s(t, set->tooth_m, from);
    return middle_s > 0.0 ? table_s / middle_s : 1.0;
}

// Where along the recording the trajectory begins and ends.
static void split(const struct dig_machine *const machine, const struct dig_curve_set *const set,
                  const struct dig_route *const route, const struct dig_vertices *const v,
                  const struct found *const found, struct dig_machine_dig *const dig)
{
    // The last sample still at the start, and the first at the end.
    const size_t from   = v->sample[found->start > 12 ? found->start - 12 : 0];
    const size_t to     = found->end < v->count ? v->sample[found->end] : dig->samples;
    double       last   = found->begin;
    double       from_s = (double)NAN; // of the middle, and to
    double       to_s   = (double)NAN;
    // A recording that begins or ends in its dig tells the pace of what it has.
    const double first_share = fmax(found->begin + begin_step, blended_share);
    const double last_share  = fmin(found->last - 0.5 * begin_step, 1.0 - blended_share);
    dig->contact             = from;
    dig->end                 = to;
    for (size_t i = from; i < dig->samples; i++) {
        const struct dig_path_point point = point_of(machine, set, dig, i);
        const struct dig_path_point at    = dig_track_turned(&dig->track, &point);
        const struct dig_projection place = dig_route_project(
            route, dig->track.dx_m, dig->track.dz_m, &at, last - 0.05, fmin(last + 0.1, 1.0));
        if (place.distance_m > 2.0 * limit_share * set->tooth_m) {
            continue;
        }
        last = fmax(last, place.progress);
        if (last <= 0.0) {
            dig->contact = i + 1;
        }
        from_s = isnan(from_s) && last >= first_share ? dig->time_s[i] : from_s;
        to_s   = isnan(to_s) && last >= last_share ? dig->time_s[i] : to_s;
        if (last >= 1.0 - 1e-9) {
            dig->end = i;
            break;
        }
    }
    dig->pace = pace_of(set, dig, first_share, last_share, (to_s - from_s) / sqrt(dig->lambda));
    dig_free_air_find(v, found->start, found->end, set->tooth_m, dig);
}

// Finds the dig in the machine's frame and in the world's, and leaves the frame and vertices in
// which it lies nearer its trajectory.
static struct found find(const struct dig_machine *const   machine,
                         const struct dig_curve_set *const set, const int asked,
                         struct dig_vertices *const v, struct dig_machine_dig *const dig)
{
    dig->frame_rad = 0.0;
    lay_out(machine, set, dig, v);
    const struct found own = search(set, v, asked);
    if (!dig_machine_dig_pitch(dig, 0, dig->samples, &dig->frame_rad) ||
        !(fabs(dig->frame_rad) > 0.0)) {
        return own;
    }
    lay_out(machine, set, dig, v);
    const struct found world = search(set, v, asked);
    if (world.off_m < own.off_m) {
        return world;
    }
    dig->frame_rad = 0.0;
    lay_out(machine, set, dig, v);
    return own;
}

static enum dig_status place(const struct dig_machine *const   machine,
                             const struct dig_curve_set *const set, const int asked,
                             struct dig_vertices *const v, struct dig_machine_dig *const dig,
                             struct dig_error *const error)
{
    const struct found found   = find(machine, set, asked, v, dig);
    const double       limit_m = limit_share * set->tooth_m;
    const char *const  along =
        asked < 0 ? "any trajectory of the table" : set->trajectory[asked].name;
    if (found.trajectory < 0) {
        return dig_error_set(error, DIG_ENOMATCH, "no dig along %s found in it", along);
    }
    const struct dig_route route  = dig_approach_route(set, (size_t)found.trajectory);
    const size_t           before = found.start < 8 ? found.start : 8;
    const size_t           first  = found.start - before;

    dig->trajectory = found.trajectory;
    dig->track      = dig_machine_dig_fit(set, dig, before, found.end - first, &v->point[first]);
    if (found.end == v->count && found.last < 1.0 - end_missing && dig->track.rms_m <= limit_m) {
        return dig_error_set(error, DIG_ENOMATCH,
                             "it ends %.0f %% along %s, expected at least %.0f %%",
                             100.0 * found.last, along, 100.0 * (1.0 - end_missing));
    }
    if (!(dig->track.rms_m <= limit_m) || !(found.off_m <= 3.0 * limit_m)) {
        return dig_error_set(
            error, DIG_ENOMATCH,
            "no dig along %s in it: the nearest path lies %.3f bucket lengths off, expected at "
            "most %.2f",
            along, fmax(dig->track.rms_m, found.off_m / 3.0) / set->tooth_m, limit_share);
    }
    if (found.begin > begin_missing + 1e-9) {
        return dig_error_set(error, DIG_ENOMATCH,
                             "it begins %.0f %% along %s, expected at most %.0f %%",
                             100.0 * found.begin, along, 100.0 * begin_missing);
    }
    split(machine, set, &route, v, &found, dig);
    return DIG_OK;
}

// Two recordings in one file: air across where they meet would show a motion that nobody made.
static enum dig_status check_jump(const struct dig_machine_dig *const dig,
                                  struct dig_error *const             error)
{
    struct dig_pose_jump jump;
    if (dig_pose_jump_find(dig->samples, dig->sample, &jump)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s jumps by %.2g rad after t_s %.9g, where no machine moves so: "
                             "expected angles in rad, and one recording a file",
                             dig_signal_name(jump.signal), jump.rad,
                             1e-9 * (double)dig->sample[jump.before].time_ns);
    }
    return DIG_OK;
}

enum dig_status dig_machine_dig_make(const struct dig_machine *const           machine,
                                     const struct dig_curve_set *const         set,
                                     const struct dig_machine_recording *const recording,
                                     const int trajectory, struct dig_machine_dig *const dig,
                                     struct dig_error *const error)
{
    assert(machine != NULL && set != NULL && recording != NULL && dig != NULL);
    struct dig_machine_dig made;
    enum dig_status        status = dig_machine_dig_make_air(machine, recording, &made, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_vertices v = {
        .point  = malloc(made.samples * sizeof *v.point),
        .sample = malloc(made.samples * sizeof *v.sample),
    };
    if (v.point == NULL || v.sample == NULL) {
        status = DIG_ENOMEM;
        (void)dig_error_set(error, status, "%zu samples", made.samples);
        goto done;
    }
    made.lambda = machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    status      = check_jump(&made, error);
    if (status == DIG_OK) {
        status = dig_pressure_check(machine, recording, error);
    }
    if (status == DIG_OK) {
        status = place(machine, set, trajectory, &v, &made, error);
    }
done:
    free(v.point);
    free(v.sample);
    if (status == DIG_OK) {
        *dig = made;
    } else {
        dig_machine_dig_finish(&made);
    }
    return status;
}
