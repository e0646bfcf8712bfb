#include "closed_loop/observe.h"

#include "core/units.h"
#include "estimator/approach_fit.h"
#include "estimator/approach_slots.h"
#include "estimator/approaches.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// The recording's columns that matter, as plain arrays over its rows.
struct columns {
    size_t  rows;
    double *t_s;
    double *progress; // path travelled as a fraction of the whole
    // Of one channel, over the rows that have it.
    double *held_t_s;
    double *held_progress;
    double *raw;
    double *smooth;
};

static double step_m(const struct dig_force_row *const a, const struct dig_force_row *const b,
                     const double tooth_m)
{
    return hypot(b->pin_x_m - a->pin_x_m, b->pin_z_m - a->pin_z_m) +
           tooth_m * fabs(b->theta_deg - a->theta_deg) * DIG_RAD_PER_DEG;
}

static double fill_columns(const struct dig_recording *const recording, const double tooth_m,
                           const struct columns *const c)
{
    double path_m = 0.0;
    for (size_t i = 0; i < c->rows; i++) {
        const struct dig_force_row *const row = &recording->row[i];
        path_m += i == 0 ? 0.0 : step_m(row - 1, row, tooth_m);
        c->t_s[i]      = row->t_s;
        c->progress[i] = path_m;
    }
    for (size_t i = 0; i < c->rows && path_m > 0.0; i++) {
        c->progress[i] /= path_m;
    }
    return path_m;
}

// Index of the last of n at or before this progress; calls with ascending progress walk on.
static size_t index_at(const size_t n, const double of[const], const double progress, size_t i)
{
    while (i + 2 < n && of[i + 1] <= progress) {
        i++;
    }
    return i;
}

static double fraction_of(const double of[const], const size_t i, const double progress)
{
    const double span = of[i + 1] - of[i];
    return span > 0.0 ? fmin(fmax((progress - of[i]) / span, 0.0), 1.0) : 0.0;
}

static size_t row_at(const struct columns *const c, const double progress, const size_t i)
{
    return index_at(c->rows, c->progress, progress, i);
}

static double fraction_at(const struct columns *const c, const size_t i, const double progress)
{
    return fraction_of(c->progress, i, progress);
}

// RMS distance between recorded and prescribed poses at equal progress, the mean offset of the pin
// taken away (the ground may lie anywhere), in bucket lengths.
static double path_distance(const struct dig_recording *const recording,
                            const struct columns *const c, const struct dig_trajectory *const t,
                            const double tooth_m)
{
    enum { POINTS = 64 };
    double x_m[POINTS];
    double z_m[POINTS];
    double mean_x_m = 0.0;
    double mean_z_m = 0.0;
    double turn2_m2 = 0.0;
    size_t i        = 0;
    for (int k = 0; k < POINTS; k++) {
        const double progress = (double)k / (POINTS - 1);
        i                     = row_at(c, progress, i);
        const double f        = fraction_at(c, i, progress);

        const struct dig_force_row *const a = &recording->row[i];
        const struct dig_force_row *const b = a + 1;
        const double                      theta_rad =
            (a->theta_deg + f * (b->theta_deg - a->theta_deg)) * DIG_RAD_PER_DEG;
        const struct dig_pose pose =
            dig_trajectory_pose(t, dig_trajectory_time_s(t, tooth_m, progress));
        x_m[k] = a->pin_x_m + f * (b->pin_x_m - a->pin_x_m) - pose.x_m;
        z_m[k] = a->pin_z_m + f * (b->pin_z_m - a->pin_z_m) - pose.z_m;
        mean_x_m += x_m[k] / POINTS;
        mean_z_m += z_m[k] / POINTS;
        turn2_m2 += pow(tooth_m * (theta_rad - pose.theta_rad), 2.0);
    }
    double sum_m2 = turn2_m2;
    for (int k = 0; k < POINTS; k++) {
        sum_m2 += pow(x_m[k] - mean_x_m, 2.0) + pow(z_m[k] - mean_z_m, 2.0);
    }
    return sqrt(sum_m2 / POINTS) / tooth_m;
}

// The way at equal steps of progress.
static void lay_out(const struct dig_recording *const recording, const struct columns *const c,
                    const double tooth_m, struct dig_path_point way[const DIG_APPROACH_FIT_POINTS])
{
    size_t i = 0;
    for (int k = 0; k < DIG_APPROACH_FIT_POINTS; k++) {
        const double progress = (double)k / (DIG_APPROACH_FIT_POINTS - 1);
        i                     = row_at(c, progress, i);
        const double f        = fraction_at(c, i, progress);

        const struct dig_force_row *const a = &recording->row[i];
        const struct dig_force_row *const b = a + 1;
        way[k]                              = (struct dig_path_point){
                                         .x_m = a->pin_x_m + f * (b->pin_x_m - a->pin_x_m),
                                         .z_m = a->pin_z_m + f * (b->pin_z_m - a->pin_z_m),
                                         .turn_m =
                                             tooth_m * DIG_RAD_PER_DEG * (a->theta_deg + f * (b->theta_deg - a->theta_deg)),
        };
    }
}

// The same as path_distance() from the trajectory dug as the way was, with what of that the table
// does not reach in quadrature.
static double fit_distance(const struct dig_recording *const recording,
                           const struct columns *const c, const struct dig_curve_set *const set,
                           const size_t trajectory, struct dig_approach *const made,
                           struct dig_approach *const reached)
{
    struct dig_path_point way[DIG_APPROACH_FIT_POINTS];
    lay_out(recording, c, set->tooth_m, way);
    const double off_m = dig_approach_fit(&set->trajectory[trajectory], set->tooth_m,
                                          set->approaches->depth_m[trajectory], way, made);
    return hypot(off_m, dig_approach_clamp(set, trajectory, made, reached)) / set->tooth_m;
}

static double channel_of(const struct dig_force_row *const row, const enum dig_channel channel)
{
    if (channel == DIG_CHANNEL_MY_Nm) {
        return row->My_Nm;
    }
    return channel == DIG_CHANNEL_FX_N ? row->Fx_N : row->Fz_N;
}

// Takes over the rows that have a channel; returns how many.
static size_t hold_channel(const struct dig_recording *const recording,
                           const struct columns *const c, const enum dig_channel channel)
{
    size_t held = 0;
    for (size_t i = 0; i < c->rows; i++) {
        c->raw[held]           = channel_of(&recording->row[i], channel);
        c->held_t_s[held]      = c->t_s[i];
        c->held_progress[held] = c->progress[i];
        held += isfinite(c->raw[held]) ? 1 : 0;
    }
    return held;
}

// The longest time that none of the held rows tells of, from the recording's first row to its last.
static double longest_gap_s(const struct columns *const c, const size_t held)
{
    double gap_s = 0.0;
    for (size_t i = 0; i <= held; i++) {
        const double from_s = i == 0 ? c->t_s[0] : c->held_t_s[i - 1];
        const double to_s   = i == held ? c->t_s[c->rows - 1] : c->held_t_s[i];
        gap_s               = fmax(gap_s, to_s - from_s);
    }
    return gap_s;
}

// Smooths one channel and reads it off at the grid's progress. False, and 0 everywhere, when rows
// lack it for longer than the smoothing reaches to one side.
static bool read_channel(const struct dig_curve_set *const set,
                         const struct dig_recording *const recording, const struct columns *const c,
                         const enum dig_channel channel, double value[DIG_CURVE_POINTS])
{
    const size_t held = hold_channel(recording, c, channel);
    const bool   told =
        held == c->rows || (held >= 2 && longest_gap_s(c, held) <= set->smooth_half_s);
    if (told) {
        dig_curve_smooth(held, c->held_t_s, c->raw, set->smooth_half_s, c->smooth);
    }
    size_t i = 0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        value[k] = 0.0;
        if (told) {
            const double progress = (double)k / (DIG_CURVE_POINTS - 1);
            i                     = index_at(held, c->held_progress, progress, i);
            const double f        = fraction_of(c->held_progress, i, progress);
            value[k]              = c->smooth[i] + f * (c->smooth[i + 1] - c->smooth[i]);
        }
    }
    return told;
}

static enum dig_status find_trajectory(const struct dig_curve_set *const set,
                                       const struct dig_recording *const recording,
                                       const struct columns *const c, const bool as_dug,
                                       struct dig_observed *const observed,
                                       struct dig_error *const    error)
{
    int    best          = -1;
    double best_distance = INFINITY;
    for (size_t t = 0; t < set->trajectories; t++) {
        struct dig_approach made     = dig_approach_plain();
        struct dig_approach approach = dig_approach_plain();
        const double        away     = as_dug && dig_approach_varies(set, t)
                                           ? fit_distance(recording, c, set, t, &made, &approach)
                                           : path_distance(recording, c, &set->trajectory[t], set->tooth_m);
        if (away < best_distance) {
            best               = (int)t;
            best_distance      = away;
            observed->made     = made;
            observed->approach = approach;
        }
    }
    if (best < 0 || !(best_distance <= DIG_OBSERVE_PATH_LIMIT)) {
        return dig_error_set(error, DIG_ENOMATCH,
                             "the recording's path is none of the table's: nearest is \"%s\", "
                             "%.3f bucket lengths away, expected at most %.2f",
                             best < 0 ? "" : set->trajectory[best].name, best_distance,
                             DIG_OBSERVE_PATH_LIMIT);
    }
    observed->trajectory = best;
    observed->off_path_m = best_distance * set->tooth_m;
    return DIG_OK;
}

static enum dig_status observe(const struct dig_curve_set *const set,
                               const struct dig_recording *const recording,
                               const struct columns *const c, const bool as_dug,
                               struct dig_observed *const observed, struct dig_error *const error)
{
    if (!(fill_columns(recording, set->tooth_m, c) > 0.1 * set->tooth_m)) {
        return dig_error_set(error, DIG_EINVAL,
                             "the recording's bucket hardly moves, expected a dig");
    }
    struct dig_observed   o      = { .trajectory = 0 };
    const enum dig_status status = find_trajectory(set, recording, c, as_dug, &o, error);
    if (status != DIG_OK) {
        return status;
    }
    o.pace = dig_trajectory_duration_s(&set->trajectory[o.trajectory]) /
             (c->t_s[c->rows - 1] - c->t_s[0]);
    for (int channel = 0; channel < DIG_FORCE_CHANNELS; channel++) {
        o.measured[channel] =
            read_channel(set, recording, c, (enum dig_channel)channel, o.value[channel]);
    }
    if (!o.measured[DIG_CHANNEL_MY_Nm]) {
        return dig_error_set(error, DIG_EINVAL,
                             "My_Nm is missing for more than %.2f s, expected the moment of the "
                             "whole dig",
                             set->smooth_half_s);
    }
    *observed = o;
    return DIG_OK;
}

static enum dig_status observe_any(const struct dig_curve_set *const set,
                                   const struct dig_recording *const recording, const bool as_dug,
                                   struct dig_observed *const observed,
                                   struct dig_error *const    error)
{
    assert(set != NULL && recording != NULL && observed != NULL);
    if (recording->rows < 2) {
        return dig_error_set(error, DIG_EINVAL, "the recording has %zu rows, expected 2 or more",
                             recording->rows);
    }
    const size_t  n      = recording->rows;
    double *const memory = calloc(6 * n, sizeof *memory);
    if (memory == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    const struct columns columns = {
        n, memory, memory + n, memory + 2 * n, memory + 3 * n, memory + 4 * n, memory + 5 * n
    };
    const enum dig_status status = observe(set, recording, &columns, as_dug, observed, error);
    free(memory);
    return status;
}

enum dig_status dig_observe_dig(const struct dig_curve_set *const set,
                                const struct dig_recording *const recording,
                                struct dig_observed *const observed, struct dig_error *const error)
{
    return observe_any(set, recording, false, observed, error);
}

enum dig_status dig_observe_as_dug(const struct dig_curve_set *const set,
                                   const struct dig_recording *const recording,
                                   struct dig_observed *const        observed,
                                   struct dig_error *const           error)
{
    return observe_any(set, recording, true, observed, error);
}

enum dig_status dig_observe_recording(const struct dig_curve_set *const set,
                                      const struct dig_recording *const recording,
                                      struct dig_observation *const     observation,
                                      struct dig_error *const           error)
{
    assert(observation != NULL);
    struct dig_observed   o      = { .trajectory = 0 };
    const enum dig_status status = dig_observe_dig(set, recording, &o, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_observation seen = { .dig_count  = 1,
                                    .trajectory = o.trajectory,
                                    .off_path_m = o.off_path_m,
                                    .first      = 0.0,
                                    .last       = 1.0 };
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        seen.moment_Nm[k] = o.value[DIG_CHANNEL_MY_Nm][k];
    }
    *observation = seen;
    return DIG_OK;
}

enum dig_status dig_observe_mean(const size_t n, const struct dig_observation one[],
                                 struct dig_observation *const mean, struct dig_error *const error)
{
    assert(mean != NULL);
    if (n == 0) {
        return dig_error_set(error, DIG_EINVAL, "no recording, expected one or more");
    }
    struct dig_observation sum = { .dig_count  = one[n - 1].dig_count,
                                   .trajectory = one[0].trajectory,
                                   .first      = one[0].first,
                                   .last       = one[0].last };
    for (size_t i = 0; i < n; i++) {
        if (one[i].trajectory != sum.trajectory) {
            return dig_error_set(error, DIG_EINVAL,
                                 "recordings of different trajectories, expected digs along one");
        }
        sum.off_path_m = fmax(sum.off_path_m, one[i].off_path_m);
        sum.first      = fmax(sum.first, one[i].first);
        sum.last       = fmin(sum.last, one[i].last);
    }
    if (!(sum.last > sum.first)) {
        return dig_error_set(error, DIG_EINVAL, "the digs have no part of the path in common");
    }
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        for (size_t i = 0; i < n && at >= sum.first && at <= sum.last; i++) {
            sum.moment_Nm[k] += one[i].moment_Nm[k] / (double)n;
            sum.sigma_Nm[k] = hypot(sum.sigma_Nm[k], one[i].sigma_Nm[k] / (double)n);
        }
    }
    *mean = sum;
    return DIG_OK;
}
