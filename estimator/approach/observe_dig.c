#include "estimator/approach/observe_dig.h"

#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/track/abort_detection.h"
#include "estimator/track/ending.h"
#include "estimator/track/window.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// The soil is searched from deeper than the table was dug by this factor, to detect digs off it.
static const double probe_deeper = 1.5;

// Observes a dig whose trajectory the table has at several depths and attacks, over the path of one
// deeper than any. The attack is the track's turn; where the soil began to resist tells roughly how
// deep it was.
static enum dig_status observe_as_dug(const struct dig_curve_set *const set, const double limit_m,
                                      const struct dig_track *const  track,
                                      struct dig_recorded_dig *const recording,
                                      struct dig_observation *const  out)
{
    const size_t t = (size_t)out->trajectory;
    const double deepest =
        fmin(probe_deeper * dig_approach_depths(set, t).most, DIG_APPROACH_DEPTH_MOST);
    const double           attack_rad = track->turn_m / set->tooth_m;
    const struct dig_route deep       = dig_approach_route_deep(set, t, deepest);
    const enum dig_status  status     = dig_window_observe(&recording->window, &deep, track,
                                                           2.0 * limit_m, set->smooth_half_s, out);
    if (status == DIG_OK) {
        out->approach = (struct dig_approach){ deepest, attack_rad };
        out->made     = (struct dig_approach){
                .depth      = dig_approach_depth(set, t, deepest, attack_rad, out->first, out->last,
                                                 out->moment_Nm),
                .attack_rad = attack_rad,
        };
    }
    return status;
}

// Observes a dig along a plain trajectory. After an abort, a way out near a later leg is not dug.
static enum dig_status observe_plain(const struct dig_curve_set *const set, const double limit_m,
                                     const struct dig_route route[], const struct dig_track whole[],
                                     struct dig_recorded_dig *const recording,
                                     struct dig_observation *const  out)
{
    const int                  t = out->trajectory;
    struct dig_abort_detection aborted;
    const bool                 left = !recording->missing &&
                      dig_abort_detection_choose(set->trajectories, route, &recording->path,
                                                 limit_m, whole, &aborted) == t;
    const struct dig_track *const track = left ? &aborted.track : &whole[t];
    const enum dig_status         status =
        dig_window_observe(&recording->window, &route[t], track, left ? limit_m : 2.0 * limit_m,
                           set->smooth_half_s, out);
    if (status == DIG_OK && out->ending == DIG_ENDING_ABORTED &&
        !dig_ending_is_known(&route[t], track, &recording->path, limit_m)) {
        out->ending = DIG_ENDING_OPEN;
    }
    return status;
}

static void make_routes(const struct dig_curve_set *const set,
                        struct dig_route                  route[const DIG_TRAJECTORY_MAX])
{
    for (size_t t = 0; t < set->trajectories; t++) {
        route[t] = dig_approach_route(set, t);
    }
}

static double nearest_m(const size_t routes, const struct dig_track track[])
{
    double least_m = INFINITY;
    for (size_t r = 0; r < routes; r++) {
        least_m = fmin(least_m, track[r].rms_m);
    }
    return least_m;
}

// Fits the path in the machine's frame and, where that is pitched, in the world's, and leaves it in
// that in which it lies nearer a trajectory. Which trajectory: -1: none.
static int fit_path(const struct dig_curve_set *const set, const double limit_m,
                    const struct dig_route route[], struct dig_recorded_dig *const recording,
                    struct dig_track fitted[const DIG_TRAJECTORY_MAX])
{
    const double     pitch_rad = dig_recorded_dig_pitch_rad(recording);
    struct dig_track turned[DIG_TRAJECTORY_MAX];
    const int own = dig_track_fit_all(set->trajectories, route, &recording->path, limit_m, fitted);
    if (!(fabs(pitch_rad) > 0.0)) {
        return own;
    }
    dig_recorded_dig_turn(recording, set, pitch_rad);
    const int world =
        dig_track_fit_all(set->trajectories, route, &recording->path, limit_m, turned);
    if (nearest_m(set->trajectories, turned) < nearest_m(set->trajectories, fitted)) {
        memcpy(fitted, turned, set->trajectories * sizeof turned[0]);
        // It is not turned again, where it is observed again.
        recording->pitch_rad = 0.0;
        return world;
    }
    dig_recorded_dig_turn(recording, set, -pitch_rad);
    return own;
}

// Chooses the trajectory by the whole path, and observes along it.
enum dig_status dig_recorded_dig_observe(const struct dig_curve_set *const          set,
                                         const struct dig_estimator_settings *const settings,
                                         struct dig_recorded_dig *const             recording,
                                         struct dig_observation *const              observation)
{
    assert(set != NULL && settings != NULL && recording != NULL && observation != NULL);
    const double     limit_m = settings->path_limit_m;
    struct dig_route route[DIG_TRAJECTORY_MAX];
    struct dig_track fitted[DIG_TRAJECTORY_MAX];
    make_routes(set, route);
    dig_recorded_dig_steady(recording, set);
    const int chosen = fit_path(set, limit_m, route, recording, fitted);
    if (chosen < 0) {
        return DIG_ENOMATCH;
    }
    struct dig_observation out = { .dig_count = recording->dig_count, .trajectory = chosen };
    const enum dig_status  status =
        dig_approach_varies(set, (size_t)chosen)
             ? observe_as_dug(set, limit_m, &fitted[chosen], recording, &out)
             : observe_plain(set, limit_m, route, fitted, recording, &out);
    if (status != DIG_OK) {
        return status;
    }
    if (!(out.last - out.first >= DIG_ENDING_LEAST)) {
        return DIG_ENOMATCH;
    }
    *observation = out;
    return DIG_OK;
}

bool dig_recorded_dig_was_aborted(const struct dig_curve_set *const          set,
                                  const struct dig_estimator_settings *const settings,
                                  const struct dig_recorded_dig *const       recording,
                                  int *const trajectory, double *const progress)
{
    assert(set != NULL && settings != NULL && recording != NULL && trajectory != NULL &&
           progress != NULL);
    const double               limit_m = settings->path_limit_m;
    struct dig_route           route[DIG_TRAJECTORY_MAX];
    struct dig_track           whole[DIG_TRAJECTORY_MAX];
    struct dig_abort_detection aborted;
    make_routes(set, route);
    (void)dig_track_fit_all(set->trajectories, route, &recording->path, limit_m, whole);
    const int left = recording->missing
                         ? -1
                         : dig_abort_detection_choose(set->trajectories, route, &recording->path,
                                                      limit_m, whole, &aborted);
    if (left < 0) {
        return false;
    }
    *trajectory = left;
    *progress   = aborted.progress;
    return true;
}
