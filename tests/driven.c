#include "tests/driven.h"

#include "core/units.h"
#include "estimator/approach/observe_dig.h"
#include "estimator/estimator_state.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>

static const double tick_s      = 0.005;
static const double rig_tooth_m = 0.09;

static const struct made_options plain  = { .relative_sd = 0.1, .packings = 3 };
static const struct dig_gravel   gravel = { { 0.6, 0.5, 2500 } };

const double driven_look_at[DRIVEN_LOOKS] = { 0.3, 0.45, 0.6, 0.9 };

struct driven *driven_create(const bool sensors)
{
    struct driven *const b = calloc(1, sizeof *b);
    b->machine             = model_machine();
    if (sensors) {
        b->machine.pressure_step_Pa = 2e5;
        b->machine.angle_step_rad   = 4e-4;
        b->machine.angle_sigma_rad  = 2e-4;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        b->machine.cylinder[j].pressure_sigma_Pa = 5e4;
    }
    b->set                                       = made_table(&plain);
    b->estimator                                 = malloc(dig_estimator_size());
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    assert_int_equal(dig_estimator_init(b->estimator, &b->machine, b->set, &settings), DIG_OK);
    return b;
}

void driven_destroy(struct driven *const b)
{
    made_table_destroy(b->set);
    free(b->estimator);
    free(b->live);
    free(b);
}

double driven_moment_Nm(const enum made_trajectory which, const double progress)
{
    return pow(driven_lambda, 4.0) * made_moment_Nm(&gravel, which, progress, 0.0);
}

static unsigned long allocations(const struct driven *const b)
{
    return b->allocations != NULL ? *b->allocations : 0;
}

// Observes the dig that ended in this tick.
static bool take(struct driven *const b)
{
    struct dig_recorded_dig *const raw = dig_estimator_take_recording(b->estimator);
    if (raw == NULL) {
        return false;
    }
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    const bool any = dig_recorded_dig_observe(b->set, &settings, raw, &b->observation) == DIG_OK;
    b->gave_up     = !any && dig_recorded_dig_was_aborted(b->set, &settings, raw, &b->gave_up_of,
                                                          &b->gave_up_at);
    if (!b->keeps) {
        dig_estimator_lend(b->estimator, raw);
    }
    return any;
}

void driven_tick(struct driven *const b, const struct dig_pose pose, const double up_m,
                 const double moment_Nm, const double drop, uint64_t *const seed)
{
    const double X_m = 7.9 - driven_lambda * pose.x_m;
    const double Z_m = -2.75 + driven_lambda * (pose.z_m + up_m);
    double       joint_rad[DIG_JOINTS];
    model_joints(&b->machine, X_m, Z_m, -0.5 * DIG_PI - pose.theta_rad, joint_rad);

    // Forces are those of the family: Fx -8, Fz 5 per Nm, both at rig scale.
    const struct model_load load = { .FX_N = 8.0 * moment_Nm / driven_lambda,
                                     .FZ_N = 5.0 * moment_Nm / driven_lambda,
                                     .M_Nm = moment_Nm };
    b->time_s += tick_s;
    struct dig_sample sample =
        model_sample(&b->machine, joint_rad, 0.0, &load, 0.95e6, (int64_t)(1e9 * b->time_s));
    if (b->machine.pressure_step_Pa > 0.0) {
        model_sense(&b->machine, &sample, seed);
    }
    const bool dropped = model_uniform(seed) < drop;
    if (dropped) {
        sample.valid[DIG_SIGNAL_BUCKET_HEAD_Pa] = false;
    }

    const unsigned long   before = allocations(b);
    const enum dig_status status = dig_estimator_step(b->estimator, &sample, &b->estimate);
    b->steps_with_allocation += allocations(b) != before ? 1 : 0;
    assert_int_equal(status, dropped ? DIG_ESTALE : DIG_OK);
    b->observations += take(b) ? 1 : 0;
    if (b->live != NULL && !dropped) {
        dig_live_recording_add(b->live, b->set, driven_lambda, &b->estimate);
        assert_true(b->live->digging ==
                    (!dig_estimator_is_idle(b->estimator) && b->estimate.phase != DIG_PHASE_AIR));
    }
}

static void look_ahead(struct driven *const b, const struct drive *const drive,
                       const double progress)
{
    if (b->estimate.trajectory < 0) {
        return;
    }
    b->known_at_end = b->estimate.trajectory;
    if (b->estimate.trajectory != (int)drive->which) {
        return;
    }
    b->known_from = isnan(b->known_from) ? progress : b->known_from;

    // On the first leg contact is all there is to tell the start by; its end tells the rest.
    if (progress > 0.4) {
        b->worst_progress = fmax(b->worst_progress, fabs(b->estimate.progress - progress));
    }

    struct dig_prediction p;
    const unsigned long   before = allocations(b);
    dig_estimator_predict(b->estimator, &p);
    b->steps_with_allocation += allocations(b) != before ? 1 : 0;
    if (!p.valid) {
        return;
    }
    b->predictions++;
    double miss = 0.0, whole = 0.0;
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double at =
            p.from_progress + (p.to_progress - p.from_progress) * i / (DIG_PREDICTION_POINTS - 1);
        const double truth_Nm = driven_moment_Nm(drive->which, at);
        miss += pow(p.moment_Nm[i] - truth_Nm, 2.0);
        whole += truth_Nm * truth_Nm;
    }
    if (p.from_progress < 0.9) {
        b->worst_prediction = fmax(b->worst_prediction, sqrt(miss / whole));
    }
}

static void look_at_shadow(struct driven *const b, const double progress)
{
    if (b->live == NULL || b->earlies == DRIVEN_LOOKS || progress < driven_look_at[b->earlies]) {
        return;
    }
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    struct dig_recorded_dig *const      scratch  = calloc(1, sizeof *scratch);
    struct dig_observation *const       early    = &b->early[b->earlies++];
    if (dig_live_recording_observe(b->set, &settings, NULL, NULL, b->live, scratch, early) !=
        DIG_OK) {
        early->trajectory = -1;
    }
    free(scratch);
}

void driven_dig(struct driven *const b, struct drive drive)
{
    const struct dig_trajectory t          = made_trajectory(drive.which);
    const double                whole_m    = dig_trajectory_path_m(&t, rig_tooth_m, 1e3);
    const double                duration_s = dig_trajectory_duration_s(&t);
    const struct dig_pose       start      = dig_trajectory_pose(&t, 0.0);
    b->earlies                             = 0;
    b->known_from                          = (double)NAN;
    b->known_at_end                        = -1;
    b->worst_progress                      = 0.0;
    b->worst_prediction                    = 0.0;
    b->predictions                         = 0;

    // Down through the air, turning a little.
    for (double left = 1.0; left > 0.0; left -= tick_s / 2.5) {
        struct dig_pose pose = start;
        pose.theta_rad -= 0.1 * left;
        pose.x_m -= 0.01 * left;
        driven_tick(b, pose, 0.03 * left, 0.0, drive.drop, &drive.seed);
    }
    double rig_s = 0.0, paused_s = 0.0, backed_s = 0.0, progress = 0.0;
    while (rig_s < duration_s && progress < drive.until) {
        progress               = dig_trajectory_path_m(&t, rig_tooth_m, rig_s) / whole_m;
        const double moment_Nm = driven_moment_Nm(drive.which, progress);
        driven_tick(b, dig_trajectory_pose(&t, rig_s), 0.0, moment_Nm, drive.drop, &drive.seed);
        look_ahead(b, &drive, progress);
        look_at_shadow(b, progress);
        if (progress > 0.45 && paused_s < drive.pause_s) {
            paused_s += tick_s;
        } else if (progress > 0.6 && backed_s <= 0.0 && drive.back_s > 0.0) {
            while (backed_s < drive.back_s) { // the soil does not push back
                backed_s += tick_s / sqrt(driven_lambda);
                driven_tick(b, dig_trajectory_pose(&t, rig_s - backed_s), 0.0, 500.0, drive.drop,
                            &drive.seed);
            }
            rig_s -= backed_s;
        } else {
            rig_s += tick_s / sqrt(driven_lambda) / drive.stretch;
        }
    }
    const struct dig_pose last = dig_trajectory_pose(&t, rig_s);
    for (double up = 0.0; up < 1.0; up += tick_s / 4.0) {
        driven_tick(b, last, 0.04 * up, drive.carry_Nm, drive.drop, &drive.seed);
    }
    for (double down = 1.0; down > 0.0; down -= tick_s / 4.0) {
        driven_tick(b, last, 0.04, drive.carry_Nm * fmax(2.0 * down - 1.0, 0.0), drive.drop,
                    &drive.seed);
    }
}

// The family's moment as the paper smooths it: the mean over +-0.16 s of rig time, here by brute
// force, over the part of the window the dig covers.
static double smoothed_Nm(const enum made_trajectory which, const double progress,
                          const double until)
{
    enum { POINTS = 200 };
    const struct dig_trajectory t       = made_trajectory(which);
    const double                whole_m = dig_trajectory_path_m(&t, rig_tooth_m, 1e3);
    const double                at_s    = dig_trajectory_time_s(&t, rig_tooth_m, progress);
    const double                from_s  = fmax(at_s - DIG_SMOOTH_HALF_s, 0.0);
    const double                end_s   = dig_trajectory_time_s(&t, rig_tooth_m, until);
    const double                to_s    = fmin(at_s + DIG_SMOOTH_HALF_s, end_s);
    double                      sum_Nm  = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double s = from_s + (to_s - from_s) * (i + 0.5) / POINTS;
        sum_Nm += made_moment_Nm(&gravel, which,
                                 dig_trajectory_path_m(&t, rig_tooth_m, s) / whole_m, 0.0);
    }
    return sum_Nm / POINTS;
}

double driven_error(const struct driven *const b, const double until)
{
    double miss = 0.0, whole = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = k / 255.0;
        if (at >= b->observation.first && at <= b->observation.last) {
            const double truth =
                smoothed_Nm((enum made_trajectory)b->observation.trajectory, at, until);
            miss += pow(b->observation.moment_Nm[k] - truth, 2.0);
            whole += truth * truth;
        }
    }
    return sqrt(miss / whole);
}
