#include "estimator/estimator.h"

#include "core/linkage.h"
#include "core/units.h"
#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/approaches.h"
#include "estimator/approach/observe_dig.h"
#include "estimator/estimator_state.h"
#include "estimator/track/abort_detection.h"
#include "estimator/track/ending.h"
#include "estimator/wrench/cylinder.h"
#include "estimator/wrench/sensed.h"
#include "estimator/wrench/wrench.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Rates of the joints come from the angles of so long.
static const double rates_window_s = 0.25;

// A rig's accelerations from the places of so long: its path is told well enough for less.
static const double sensed_window_s = 0.1;

// Filters step over longer gaps as if they were this long.
static const double longest_step_s = 0.1;

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

// Forgets the dig going on.
static void forget_dig(struct dig_estimator *const e)
{
    dig_recorded_dig_clear(e->recording, e->set);
    e->next_follower = 0;
    e->choice        = (struct dig_choice){ .current = -1, .candidate = -1 };
    e->progress      = (double)NAN;
    e->off_path_m    = (double)NAN;
}

enum dig_status dig_estimator_init(struct dig_estimator *const                estimator,
                                   const struct dig_machine *const            machine,
                                   const struct dig_curve_set *const          set,
                                   const struct dig_estimator_settings *const settings)
{
    assert(estimator != NULL && machine != NULL && set != NULL && settings != NULL);
    const char *reason = NULL;
    if (dig_estimator_settings_check(settings, &reason) != DIG_OK ||
        dig_machine_check(machine, NULL) != DIG_OK || !set_is_sound(set)) {
        return DIG_EINVAL;
    }
    const enum dig_status closes = dig_linkage_check(machine, NULL);
    if (closes != DIG_OK) {
        return closes;
    }

    // A megabyte: cleared in place, not by way of the stack.
    memset(estimator, 0, sizeof *estimator);
    estimator->machine   = machine;
    estimator->settings  = *settings;
    estimator->recording = &estimator->own_recording;
    estimator->rates     = (struct dig_rates_filter){ .window_s = sensed_window_s };
    dig_estimator_set_table(estimator, set);
    return DIG_OK;
}

bool dig_estimator_is_idle(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return !estimator->recording->window.open;
}

bool dig_estimator_is_off_table(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    const int told = estimator->choice.current;
    bool      off  = estimator->recording->window.open && estimator->set->trajectories > 0;
    if (off && told >= 0 && estimator->forecast != NULL &&
        estimator->forecast->expected[told].off_table) {
        return true;
    }
    for (size_t t = 0; off && t < estimator->set->trajectories; t++) {
        off = estimator->follower[t].track.rms_m > estimator->settings.path_limit_m;
    }
    return off;
}

void dig_estimator_set_table(struct dig_estimator *const       estimator,
                             const struct dig_curve_set *const set)
{
    assert(estimator != NULL && set != NULL && dig_estimator_is_idle(estimator));
    estimator->set      = set;
    estimator->forecast = NULL;
    estimator->motion   = (struct dig_motion_state){ .towed = false };
    estimator->lambda   = estimator->machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    for (size_t t = 0; t < set->trajectories; t++) {
        estimator->route[t] = dig_approach_route(set, t);
    }
    forget_dig(estimator);
}

// The bucket in rig scale and axes.
static struct dig_path_point rig_point(const struct dig_estimator *const e,
                                       const struct dig_front *const     front)
{
    const struct dig_vec2 *const pin = &front->pin_m[DIG_JOINT_BUCKET];
    return dig_recorded_dig_point(e->set, e->lambda, pin->x, pin->y,
                                  front->attitude_rad[DIG_JOINT_BUCKET]);
}

// Vertices of the samples before contact, then the one in contact.
static void lay_out_path(struct dig_estimator *const e, const struct dig_path_point *const touched)
{
    dig_recorded_dig_contact(e->recording, touched);
    for (size_t t = 0; t < e->set->trajectories; t++) {
        e->follower[t] =
            dig_follower_start(&e->route[t], &e->recording->path, e->settings.path_limit_m);
    }
}

// One trajectory a tick is fitted again: constant time, and each is up to date within a few ticks.
static void follow_path(struct dig_estimator *const e, const struct dig_path_point *const point)
{
    const size_t tracks = e->set->trajectories;
    if (tracks == 0) {
        return;
    }
    const bool in_soil = e->phase.phase == DIG_PHASE_CONTACT || e->phase.phase == DIG_PHASE_DIG;
    (void)dig_path_add(&e->recording->path, point, in_soil);
    e->next_follower     = (e->next_follower + 1) % tracks;
    const double limit_m = e->settings.path_limit_m;
    dig_follower_step(&e->route[e->next_follower], &e->recording->path, limit_m,
                      &e->follower[e->next_follower]);

    const struct dig_track *track_of[DIG_TRAJECTORY_MAX];
    for (size_t t = 0; t < tracks; t++) {
        track_of[t] = &e->follower[t].track;
    }
    const int before = e->choice.current;
    const int chosen = dig_track_choose(tracks, track_of, limit_m, DIG_TRACK_TIE_SHARE * limit_m,
                                        e->choice.candidate);
    const int told   = dig_choice_step(&e->choice, tracks, chosen);
    if (told != before) {
        e->progress = (double)NAN;
    }
    if (told < 0) {
        dig_followed_off(&e->recording->followed);
        e->progress   = (double)NAN;
        e->off_path_m = (double)NAN;
        return;
    }
    const struct dig_track *const track = &e->follower[told].track;

    // Where it was a tick ago, or at its last vertex in soil.
    const double behind = fmin(fmin(e->progress, 1.0), track->progress) - 0.1;
    const double ahead  = fmax(fmax(e->progress, 0.0), track->progress) + 0.2;

    const struct dig_path_point at = dig_track_turned(track, point);
    const struct dig_projection place =
        dig_route_project(&e->route[told], track->dx_m, track->dz_m, &at, behind, fmin(ahead, 1.0));
    e->progress   = place.progress;
    e->off_path_m = place.distance_m;
    dig_followed_on(&e->recording->followed, told, e->progress, e->off_path_m, limit_m,
                    &e->recording->path);
}

// The trajectory is done, or nearly, and the bucket has left it.
static bool path_is_over(const struct dig_estimator *const e)
{
    return e->choice.current >= 0 && e->progress >= DIG_ENDING_WHOLE_FROM &&
           e->off_path_m > e->settings.path_limit_m;
}

// Hands the dig out raw and goes on in the spare, or observes it here.
static void finish_dig(struct dig_estimator *const e)
{
    e->recording->dig_count = ++e->digs;
    if (!e->lends) {
        e->has_observation |=
            dig_recorded_dig_observe(e->set, &e->settings, e->recording, &e->observation) == DIG_OK;
    } else if (e->spare != NULL && e->finished == NULL) {
        e->finished  = e->recording;
        e->recording = e->spare;
        e->spare     = NULL;
    } else {
        e->lost++;
    }
    forget_dig(e);
}

void dig_estimator_lend(struct dig_estimator *const estimator, struct dig_recorded_dig *const spare)
{
    assert(estimator != NULL && spare != NULL && estimator->spare == NULL);
    estimator->lends = true;
    estimator->spare = spare;
}

bool dig_estimator_wants_spare(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return estimator->spare == NULL;
}

struct dig_recorded_dig *dig_estimator_take_recording(struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    struct dig_recorded_dig *const finished = estimator->finished;
    estimator->finished                     = NULL;
    return finished;
}

uint32_t dig_estimator_lost_digs(const struct dig_estimator *const estimator)
{
    assert(estimator != NULL);
    return estimator->lost;
}

// Moves phase, window and path on by one valid moment.
static void follow_dig(struct dig_estimator *const e, const int64_t time_ns, const double dt_s,
                       const struct dig_wrench *const     wrench,
                       const struct dig_path_point *const point)
{
    const enum dig_phase_event event =
        dig_phase_step(&e->phase, &e->settings, dt_s, wrench->My_Nm, wrench->sigma_My_Nm,
                       wrench->slow_sigma_My_Nm);
    dig_recorded_dig_add(e->recording, e->lambda, time_ns, wrench, e->phase.bias_Nm, point);
    dig_followed_sample(&e->recording->followed, e->recording->window.open, time_ns,
                        sqrt(e->lambda) * dig_window_hole_s(e->set->smooth_half_s));

    switch (event) {
    case DIG_EVENT_CONTACT: lay_out_path(e, point); break;
    case DIG_EVENT_LOST: forget_dig(e); break;
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

void dig_estimator_set_machine(struct dig_estimator *const               estimator,
                               const struct dig_corrected_machine *const corrected)
{
    assert(estimator != NULL && corrected != NULL && dig_estimator_is_idle(estimator));
    struct dig_corrected_machine *const before = &estimator->corrected;
    if (corrected->corrects == before->corrects &&
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c)
        memcmp(&corrected->correction, &before->correction, sizeof before->correction) == 0) {
        return;
    }
    if (corrected->corrects && !before->corrects) {
        estimator->rates = (struct dig_rates_filter){ .window_s = rates_window_s };
    }
    *before = *corrected;

    dig_phase_reset(&estimator->phase);
}

enum dig_status dig_estimator_set_correction(struct dig_estimator *const        estimator,
                                             const struct dig_correction *const correction)
{
    assert(estimator != NULL);
    struct dig_corrected_machine corrected;
    const enum dig_status status = dig_correction_apply(estimator->machine, correction, &corrected);
    if (status == DIG_OK) {
        dig_estimator_set_machine(estimator, &corrected);
    }
    return status;
}

// The wrench of a rig by its force sensor, inertia taken off. A number that is not finite must not
// enter the filter.
static enum dig_status solve_sensed(struct dig_estimator *const    e,
                                    const struct dig_sample *const sample,
                                    struct dig_wrench *const wrench, struct dig_front *const front)
{
    const struct dig_sensed_motion still = { .turn_radps = 0.0 };
    const enum dig_status status = dig_sensed_solve(e->machine, sample, &still, wrench, front);
    if (status != DIG_OK) {
        return status;
    }
    const struct dig_sensed_motion motion = dig_sensed_move(&e->rates, e->machine, sample);
    return dig_sensed_solve(e->machine, sample, &motion, wrench, front);
}

// The wrench of the machine as it is taken to be. With a delay the parabola of the last angles is
// read off where they were when the pressures were.
static enum dig_status solve(struct dig_estimator *const e, const struct dig_sample *const sample,
                             struct dig_wrench *const wrench, struct dig_front *const front)
{
    if (e->machine->sensor.fitted) {
        return solve_sensed(e, sample, wrench, front);
    }
    if (!e->corrected.corrects) {
        return dig_wrench_solve(e->machine, sample, wrench, front);
    }
    if (!dig_sample_has_moment(sample)) {
        return DIG_ESTALE;
    }
    struct dig_sample   at = *sample;
    struct dig_rates    rates;
    const double *const now_rad = &sample->value[DIG_SIGNAL_BOOM_rad];
    if (!isfinite(now_rad[0]) || !isfinite(now_rad[1]) || !isfinite(now_rad[2])) {
        return DIG_EINVAL;
    }
    rates =
        dig_rates_step(&e->rates, sample->time_ns, now_rad,
                       dig_reading_sigma(e->machine->angle_step_rad, e->machine->angle_sigma_rad));
    const double delay_s = e->corrected.correction.delay_s;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double back_rad =
            delay_s * (rates.velocity_radps[j] - 0.5 * delay_s * rates.acceleration_radps2[j]);
        at.value[DIG_SIGNAL_BOOM_rad + j] -= back_rad;
        rates.velocity_radps[j] -= delay_s * rates.acceleration_radps2[j];
    }
    return dig_wrench_correct(&e->corrected.machine, &e->corrected.correction, &at, &rates, wrench,
                              front);
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
    const enum dig_status status = solve(e, sample, &wrench, &front);
    if (status != DIG_OK) {
        return status;
    }

    const double tick_s = e->settings.tick_s;
    const double dt_s   = e->started ? 1e-9 * (double)(sample->time_ns - e->last_ns) : tick_s;
    e->started          = true;
    e->last_ns          = sample->time_ns;

    const double step_s = fmin(dt_s, longest_step_s);

    // Without a moment nothing is learnt; the dig goes on from the next one.
    const struct dig_path_point point = rig_point(e, &front);
    if (wrench.moment_valid) {
        follow_dig(e, sample->time_ns, step_s, &wrench, &point);
        wrench.My_Nm -= e->phase.bias_Nm;
    }
    const enum dig_motion motion =
        dig_motion_step(&e->motion, e->set->tooth_m, step_s, e->phase.phase, &point);

    *estimate = (struct dig_estimate){
        .time_ns    = sample->time_ns,
        .wrench     = wrench,
        .pin_X_m    = front.pin_m[DIG_JOINT_BUCKET].x,
        .pin_Z_m    = front.pin_m[DIG_JOINT_BUCKET].y,
        .phi_rad    = front.attitude_rad[DIG_JOINT_BUCKET],
        .phase      = e->phase.phase,
        .dig_count  = e->digs,
        .trajectory = e->choice.current,
        .progress   = e->progress,
        .off_path_m = e->off_path_m,
        .motion     = motion,
    };
    return DIG_OK;
}

bool dig_estimator_take_observation(struct dig_estimator *const   estimator,
                                    struct dig_observation *const observation)
{
    assert(estimator != NULL && observation != NULL);
    if (!estimator->has_observation) {
        return false;
    }
    *observation               = estimator->observation;
    estimator->has_observation = false;
    return true;
}
