#include "closed_loop/recordings/observe.h"

#include "closed_loop/recordings/alignment.h"
#include "closed_loop/recordings/force_check.h"
#include "closed_loop/recordings/lateness.h"
#include "closed_loop/recordings/path_depth.h"
#include "closed_loop/recordings/reading_noise.h"
#include "core/entry_set.h"
#include "core/units.h"
#include "estimator/approach/approach_response.h"
#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// A recording that ends sooner than its trajectory by less of the smoothing's half width than this
// goes on as it ended: one of 50 Hz lacks up to 20 ms.
static const double held_share = 0.25;

// The recording's columns that matter, as plain arrays over its rows.
struct columns {
    size_t  rows;
    double *t_s;      // its own, then when the table's dig was there
    double *progress; // path travelled as a fraction of the trajectory's
    // Of one channel, over the rows that have it, and one more at either end.
    double *held_t_s;
    double *held_progress;
    double *raw;
    double *smooth;
};

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

// The longest stretch that none of the held rows tells of, from the recording's first row to its
// last, in time of the table's dig.
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

// What the recording lacks of the trajectory: time of the table's dig before and after it, and the
// progress between which smoothed values are those of a whole dig.
struct ends {
    double before_s, after_s;
    double first, last;
};

// A value that stays as it was before the first row and after the last, for as long as is missing.
static size_t extend(const struct ends *const ends, const struct columns *const c, size_t held)
{
    if (ends->after_s > 0.0 && ends->last >= 1.0) {
        c->held_t_s[held]      = c->held_t_s[held - 1] + ends->after_s;
        c->held_progress[held] = 1.0;
        c->raw[held]           = c->raw[held - 1];
        held++;
    }
    if (ends->before_s > 0.0 && ends->first <= 0.0) {
        memmove(c->held_t_s + 1, c->held_t_s, held * sizeof(double));
        memmove(c->held_progress + 1, c->held_progress, held * sizeof(double));
        memmove(c->raw + 1, c->raw, held * sizeof(double));
        c->held_t_s[0] -= ends->before_s;
        c->held_progress[0] = 0.0;
        held++;
    }
    return held;
}

// Smooths one channel and reads it and its sigma off at the grid's progress. False, and 0
// everywhere, when rows lack it over more of the path than the smoothing reaches to one side.
static bool read_channel(const struct dig_recording *const recording, const struct columns *const c,
                         const struct ends *const ends, const double half_s,
                         const enum dig_channel channel, double value[DIG_CURVE_POINTS],
                         double sigma[DIG_CURVE_POINTS])
{
    size_t       held  = hold_channel(recording, c, channel);
    const double noise = dig_reading_noise(held, c->raw);
    const bool   told  = held == c->rows || (held >= 2 && longest_gap_s(c, held) <= half_s);
    if (told) {
        held = extend(ends, c, held);
        dig_curve_smooth(held, c->held_t_s, c->raw, half_s, c->smooth);
    }
    struct dig_alignment_place at = { .row = 0 };
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        value[k]              = 0.0;
        sigma[k]              = 0.0;
        if (told && progress >= ends->first && progress <= ends->last) {
            at                  = dig_alignment_place(held, c->held_progress, progress, at.row);
            const double before = c->smooth[at.row];
            value[k]            = before + at.fraction * (c->smooth[at.row + 1] - before);
            sigma[k] = noise * sqrt(dig_curve_noise_left(held, c->held_t_s, at.row, half_s));
        }
    }
    return told;
}

// The rows from where the trajectory begins to where it ends: the bucket may have waited or gone on
// beyond, and the table's curves are smoothed over the trajectory alone.
static struct columns along_trajectory(const struct columns *const all)
{
    struct columns along = *all;
    while (along.rows > 2 && along.progress[1] <= 0.0) {
        along.progress++;
        along.t_s++;
        along.rows--;
    }
    while (along.rows > 2 && along.progress[along.rows - 2] >= 1.0) {
        along.rows--;
    }
    return along;
}

// What value is where along is at, straight between rows.
static double read_off(const struct columns *const c, const double along[], const double value[],
                       const double at)
{
    const struct dig_alignment_place place  = dig_alignment_place(c->rows, along, at, 0);
    const double                     before = value[place.row];
    return before + place.fraction * (value[place.row + 1] - before);
}

// How fast the dig was: without its first and last hundredth, about which it may have rested.
static double pace_of(const struct dig_curve_set *const set, const size_t trajectory,
                      const struct columns *const c, const struct dig_alignment_part *const part)
{
    const struct dig_trajectory *const t    = &set->trajectory[trajectory];
    const double                       rim  = 0.01 * (part->to - part->from);
    const double                       from = fmax(part->from, 0.0) + rim;
    const double                       to   = fmin(part->to, 1.0) - rim;
    return (dig_trajectory_time_s(t, set->tooth_m, to) -
            dig_trajectory_time_s(t, set->tooth_m, from)) /
           (read_off(c, c->progress, c->t_s, to) - read_off(c, c->progress, c->t_s, from));
}

// Puts every row at the time when the table's dig was where it is: what is smoothed then is as much
// of the path as the table's, whatever the pace.
static void place_in_time(const struct dig_trajectory *const t, const double tooth_m,
                          const struct columns *const c)
{
    for (size_t i = 0; i < c->rows; i++) {
        c->t_s[i] = dig_trajectory_time_s(t, tooth_m, fmin(fmax(c->progress[i], 0.0), 1.0));
    }
}

static struct ends ends_of(const struct dig_trajectory *const t, const double half_s,
                           const struct columns *const c)
{
    struct ends ends = { c->t_s[0], dig_trajectory_duration_s(t) - c->t_s[c->rows - 1], 0.0, 1.0 };
    if (ends.before_s > held_share * half_s) {
        ends.first = read_off(c, c->t_s, c->progress, c->t_s[0] + half_s);
    }
    if (ends.after_s > held_share * half_s) {
        ends.last = read_off(c, c->t_s, c->progress, c->t_s[c->rows - 1] - half_s);
    }
    return ends;
}

// By the rows along the trajectory.
static void tell_path_depth(const struct dig_curve_set *const set,
                            const struct dig_recording *const rows, const struct columns *const c,
                            struct dig_measured *const o)
{
    const size_t           t     = (size_t)o->trajectory;
    const struct dig_route route = dig_route_make(&set->trajectory[t], set->tooth_m);
    struct dig_path_depth  depth = { .poses = { 0 } };
    for (size_t i = 0; i < rows->rows; i++) {
        const struct dig_force_row *const row    = &rows->row[i];
        const double                      turn_m = set->tooth_m * DIG_RAD_PER_DEG * row->theta_deg;
        const struct dig_path_point       pose   = { row->pin_x_m, row->pin_z_m, turn_m };
        dig_path_depth_add(&depth, &route, set->tooth_m, o->made.attack_rad,
                           fmin(fmax(c->progress[i], 0.0), 1.0), &pose);
    }
    dig_path_depth_tell(&depth, &route, set->approaches->depth_m[t], o->deeper);
}

static enum dig_status observe(const struct dig_curve_set *const set,
                               const struct dig_recording *const recording,
                               const struct columns *const c, const bool as_dug,
                               struct dig_measured *const observed, struct dig_error *const error)
{
    for (size_t i = 0; i < c->rows; i++) {
        c->t_s[i] = recording->row[i].t_s;
    }
    if (!(dig_alignment_progress(recording, set->tooth_m, c->progress) > 0.1 * set->tooth_m)) {
        return dig_error_set(error, DIG_EINVAL,
                             "the recording's bucket hardly moves, expected a dig");
    }
    struct dig_alignment_part part;
    struct dig_measured       o = *observed;
    const enum dig_status     status =
        dig_path_match(set, recording, c->progress, as_dug, &o, &part, error);
    if (status != DIG_OK) {
        return status;
    }
    memset(o.deeper, 0, sizeof o.deeper);
    for (size_t i = 0; i < c->rows; i++) {
        c->progress[i] = part.from + (part.to - part.from) * c->progress[i];
    }
    const struct columns       along = along_trajectory(c);
    const struct dig_recording rows  = { along.rows, recording->row + (along.t_s - c->t_s) };
    o.pace                           = pace_of(set, (size_t)o.trajectory, &along, &part);
    if (!as_dug && dig_approach_varies(set, (size_t)o.trajectory)) {
        tell_path_depth(set, &rows, &along, &o);
    }

    const double                half_s = set->smooth_half_s;
    const struct dig_trajectory dug = dig_response_trajectory(set, (size_t)o.trajectory, &o.made);
    place_in_time(&dug, set->tooth_m, &along);
    const struct ends ends = ends_of(&dug, half_s, &along);
    o.first                = ends.first;
    o.last                 = ends.last;
    for (int channel = 0; channel < DIG_FORCE_CHANNELS; channel++) {
        o.measured[channel] = read_channel(&rows, &along, &ends, half_s, (enum dig_channel)channel,
                                           o.value[channel], o.sigma[channel]);
    }
    if (!o.measured[DIG_CHANNEL_MY_Nm]) {
        return dig_error_set(
            error, DIG_EINVAL,
            "My_Nm is missing for longer than %.2f s at the table's pace, expected "
            "the moment of the whole dig",
            half_s);
    }
    const enum dig_status sized = dig_force_check(set, &o, error);
    if (sized != DIG_OK) {
        return sized;
    }
    dig_lateness_rate(&dug, set->tooth_m, &o, o.rate);
    *observed = o;
    return DIG_OK;
}

static enum dig_status observe_any(const struct dig_curve_set *const set,
                                   const struct dig_recording *const recording, const bool as_dug,
                                   struct dig_measured *const observed,
                                   struct dig_error *const    error)
{
    assert(set != NULL && recording != NULL && observed != NULL);
    if (recording->rows < 2) {
        return dig_error_set(error, DIG_EINVAL, "the recording has %zu rows, expected 2 or more",
                             recording->rows);
    }
    const size_t                n      = recording->rows + 2;
    double *const               memory = calloc(7 * n, sizeof *memory);
    struct dig_force_row *const row    = calloc(n, sizeof *row);
    if (memory == NULL || row == NULL) {
        free(memory);
        free(row);
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    const struct columns columns = { recording->rows, memory,         memory + n,    memory + 2 * n,
                                     memory + 3 * n,  memory + 4 * n, memory + 5 * n };
    struct dig_recording steady  = { recording->rows, row };
    memcpy(row, recording->row, recording->rows * sizeof *row);
    dig_steady_path(&steady, set->tooth_m, memory);

    const enum dig_status status = observe(set, &steady, &columns, as_dug, observed, error);
    free(memory);
    free(row);
    return status;
}

enum dig_status dig_observe_dig(const struct dig_curve_set *const set,
                                const struct dig_recording *const recording,
                                struct dig_measured *const observed, struct dig_error *const error)
{
    return observe_any(set, recording, false, observed, error);
}

enum dig_status dig_observe_as_dug(const struct dig_curve_set *const set,
                                   const struct dig_recording *const recording,
                                   struct dig_measured *const        observed,
                                   struct dig_error *const           error)
{
    return observe_any(set, recording, true, observed, error);
}
