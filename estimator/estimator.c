#include "estimator/estimator.h"

#include "core/linkage.h"
#include "estimator/estimator_state.h"
#include "estimator/track/ending.h"
#include "estimator/track/frame.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Filters treat a longer gap as one of this length, so that a gap does not flush them.
static const double longest_step_s = 0.1;

// The projection is searched from this far behind to this far ahead of the last progress: more than
// a bucket advances while every trajectory is fitted once.
static const double search_behind = 0.1;
static const double search_ahead  = 0.2;

size_t dig_estimator_size(void)
{
    return sizeof(struct dig_estimator);
}

static bool set_is_sound(const struct dig_curve_set *const set)
{
    if (!(set->tooth_m > 0.0 && isfinite(set->tooth_m) && set->smooth_half_s >= 0.0) ||
        set->trajectories > DIG_TRAJECTORY_MAX) {
        return false;
    }
    for (size_t t = 0; t < set->trajectories; t++) {
        const struct dig_trajectory *const trajectory = &set->trajectory[t];
        if (trajectory->phases < 1 || trajectory->phases > DIG_PHASES_MAX ||
            !(dig_trajectory_path_m(trajectory, set->tooth_m,
                                    dig_trajectory_duration_s(trajectory)) > 0.0)) {
            return false;
        }
    }
    return true;
}

enum dig_status dig_estimator_init(struct dig_estimator *const                estimator,
                                   const struct dig_machine *const            machine,
                                   const struct dig_curve_set *const          set,
                                   const struct dig_estimator_settings *const settings)
{
    assert(estimator != NULL && machine != NULL && set != NULL && settings != NULL);
    if (!dig_estimator_settings_ok(settings) || dig_machine_check(machine, NULL) != DIG_OK ||
        !set_is_sound(set)) {
        return DIG_EINVAL;
    }
    const enum dig_status closes = dig_linkage_check(machine);
    if (closes != DIG_OK) {
        return closes;
    }

    // Four megabytes: cleared in place, not by way of the stack.
    memset(estimator, 0, sizeof *estimator);
    estimator->machine   = machine;
    estimator->settings  = *settings;
    estimator->recording = &estimator->own[0];
    estimator->spare     = &estimator->own[1];
    estimator->rates     = (struct dig_rates_filter){
            .window_s = machine->sensor.fitted ? DIG_SENSED_RATES_s : DIG_JOINT_RATES_s,
    };
    dig_estimator_set_table(estimator, set);
    return DIG_OK;
}

// The bucket's pose in rig scale and axes.
static struct dig_path_point rig_point(const struct dig_estimator *const e,
                                       const struct dig_front *const     front)
{
    const struct dig_vec2 *const pin = &front->pin_m[DIG_JOINT_BUCKET];
    return dig_recorded_dig_point(e->set, e->lambda, pin->x, pin->y,
                                  front->attitude_rad[DIG_JOINT_BUCKET]);
}

// Starts path and tracks at contact.
static void start_path(struct dig_estimator *const e, const struct dig_path_point *const contact,
                       const double pitch_rad)
{
    dig_recorded_dig_contact(e->recording, contact);
    e->frames = fabs(pitch_rad) > 0.0 ? 2 : 1;
    for (size_t t = 0; t < e->set->trajectories; t++) {
        e->frame[1].route[t] = dig_frame_route(&e->frame[0].route[t], pitch_rad, e->set->tooth_m);
        for (size_t f = 0; f < e->frames; f++) {
            e->frame[f].follower[t] = dig_follower_start(&e->frame[f].route[t], &e->recording->path,
                                                         e->settings.path_limit_m);
        }
    }
}

// Adds a point to the path, refines the track of one trajectory (constant time: each is refined
// within a few ticks), and chooses among all.
static int choose_trajectory(struct dig_estimator *const        e,
                             const struct dig_path_point *const point)
{
    const size_t tracks  = e->set->trajectories;
    const bool   in_soil = e->phase.phase == DIG_PHASE_CONTACT || e->phase.phase == DIG_PHASE_DIG;
    dig_recorded_dig_follow(e->recording, point, in_soil);
    e->next_follower     = (e->next_follower + 1) % tracks;
    const double limit_m = e->settings.path_limit_m;
    for (size_t f = 0; f < e->frames; f++) {
        dig_follower_step(&e->frame[f].route[e->next_follower], &e->recording->path, limit_m,
                          &e->frame[f].follower[e->next_follower]);
    }
    const struct dig_track *track_of[DIG_TRAJECTORY_MAX];
    for (size_t t = 0; t < tracks; t++) {
        track_of[t] = &e->frame[dig_estimator_frame(e, t)].follower[t].track;
    }
    const int chosen = dig_track_choose(tracks, track_of, limit_m, e->choice.candidate);
    return dig_choice_step(&e->choice, tracks, chosen);
}

static void follow_path(struct dig_estimator *const e, const struct dig_path_point *const point)
{
    if (e->set->trajectories == 0) {
        return;
    }
    const int before     = e->choice.current;
    const int trajectory = choose_trajectory(e, point);
    if (trajectory != before) {
        e->progress = (double)NAN;
    }
    if (trajectory < 0) {
        e->progress   = (double)NAN;
        e->off_path_m = (double)NAN;
        return;
    }
    const size_t                  t     = (size_t)trajectory;
    const size_t                  f     = dig_estimator_frame(e, t);
    const struct dig_track *const track = &e->frame[f].follower[t].track;

    // Around the progress of the last tick and of the last vertex in soil.
    const double behind = fmin(fmin(e->progress, 1.0), track->progress) - search_behind;
    const double ahead  = fmax(fmax(e->progress, 0.0), track->progress) + search_ahead;

    const struct dig_path_point at    = dig_track_turned(track, point);
    const struct dig_projection place = dig_route_project(
        &e->frame[f].route[t], track->dx_m, track->dz_m, &at, behind, fmin(ahead, 1.0));
    e->progress   = place.progress;
    e->off_path_m = place.distance_m;
}

// The trajectory is dug to its end, or nearly, and the bucket has left it.
static bool path_is_over(const struct dig_estimator *const e)
{
    return e->choice.current >= 0 && e->progress >= DIG_ENDING_WHOLE_FROM &&
           e->off_path_m > e->settings.path_limit_m;
}

// Hands the recording out and records on in the spare.
static void finish_dig(struct dig_estimator *const e)
{
    e->recording->dig_count = ++e->digs;
    if (e->spare != NULL && e->finished == NULL) {
        e->finished  = e->recording;
        e->recording = e->spare;
        e->spare     = NULL;
    } else {
        e->lost++;
    }
    dig_estimator_clear_dig(e);
}

// Steps phase, window and path by one valid moment.
static void follow_dig(struct dig_estimator *const e, const int64_t time_ns, const double dt_s,
                       const struct dig_wrench *const wrench, const double pitch_rad,
                       const struct dig_path_point *const point,
                       const double                       joint_rad[const DIG_JOINTS])
{
    // A boom that brakes is no ground; in the ground it would end no dig.
    const double doubt_Nm = e->phase.phase == DIG_PHASE_AIR ? e->inertia_Nm : 0.0;

    const enum dig_phase_event event =
        dig_phase_step(&e->phase, &e->settings, dt_s, wrench->My_Nm, wrench->sigma_My_Nm,
                       hypot(wrench->slow_sigma_My_Nm, doubt_Nm));
    dig_recorded_dig_add(e->recording, e->set, e->lambda, time_ns, wrench, e->phase.bias_Nm,
                         pitch_rad, point, joint_rad);

    switch (event) {
    case DIG_EVENT_CONTACT: start_path(e, point, pitch_rad); break;
    case DIG_EVENT_LOST: dig_estimator_clear_dig(e); break;
    case DIG_EVENT_FINISHED: finish_dig(e); break;
    case DIG_EVENT_NONE:
    default: break;
    }
    if (!e->recording->window.open) {
        return;
    }
    follow_path(e, point);
    if (path_is_over(e)) {
        finish_dig(e);
        dig_phase_end(&e->phase);
    }
}

enum dig_status dig_estimator_step(struct dig_estimator *const    estimator,
                                   const struct dig_sample *const sample,
                                   struct dig_estimate *const     estimate)
{
    assert(estimator != NULL && sample != NULL && estimate != NULL);
    struct dig_estimator *const e = estimator;
    if (e->started && sample->time_ns <= e->last_ns) {
        return DIG_ESTALE;
    }
    struct dig_wrench     wrench;
    struct dig_front      front;
    const enum dig_status status = dig_estimator_solve(e, sample, &wrench, &front);
    if (status != DIG_OK) {
        return status;
    }

    const double tick_s = e->settings.tick_s;
    const double dt_s   = e->started ? 1e-9 * (double)(sample->time_ns - e->last_ns) : tick_s;
    e->started          = true;
    e->last_ns          = sample->time_ns;

    const double step_s = fmin(dt_s, longest_step_s);

    // A sample without a moment is skipped; the dig goes on with the next one.
    const struct dig_path_point point = rig_point(e, &front);
    const double                pitch_rad =
        sample->valid[DIG_SIGNAL_PITCH_rad] ? sample->value[DIG_SIGNAL_PITCH_rad] : 0.0;
    const double *const at                    = front.attitude_rad;
    const double        joint_rad[DIG_JOINTS] = { at[0], at[1] - at[0], at[2] - at[1] };
    if (wrench.moment_valid) {
        follow_dig(e, sample->time_ns, step_s, &wrench, pitch_rad, &point, joint_rad);
        wrench.My_Nm -= e->phase.bias_Nm;
    }
    const enum dig_motion motion =
        dig_motion_step(&e->motion, e->set->tooth_m, step_s, e->phase.phase, &point);

    *estimate = (struct dig_estimate){
        .time_ns    = sample->time_ns,
        .wrench     = wrench,
        .pin_X_m    = front.pin_m[DIG_JOINT_BUCKET].x,
        .pin_Z_m    = front.pin_m[DIG_JOINT_BUCKET].y,
        .phi_rad    = at[DIG_JOINT_BUCKET],
        .joint_rad  = { joint_rad[0], joint_rad[1], joint_rad[2] },
        .pitch_rad  = pitch_rad,
        .phase      = e->phase.phase,
        .dig_count  = e->digs,
        .trajectory = e->choice.current,
        .progress   = e->progress,
        .off_path_m = e->off_path_m,
        .motion     = motion,
    };
    return DIG_OK;
}
