#include "tools/digreport/shift_dig.h"

#include "core/name.h"
#include "core/room.h"
#include "core/units.h"
#include "estimator/track/phase.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_MAX    ((size_t)1 << 20) // a quarter of an hour at a kilohertz; the rest is left out
#define STEP_MOST_s 1.0               // a longer one is a gap: the time within does not count

static double seconds(const int64_t from_ns, const int64_t to_ns)
{
    return 1e-9 * ((double)to_ns - (double)from_ns);
}

// Time from the row before that counts.
static double step_s(const struct digreport_dig_track *const t, const size_t i)
{
    const double step = i > 0 ? seconds(t->row[i - 1].time_ns, t->row[i].time_ns) : 0.0;
    return step <= STEP_MOST_s ? step : 0.0;
}

// Work on the soil from one row to the next, estimator/predict/peak_energy.h in machine axes: the
// rig's x is -X, and the bucket's attitude turns against phi.
static double work_J(const struct digreport_row *const a, const struct digreport_row *const b)
{
    const double turned_rad = remainder(b->phi_rad - a->phi_rad, 2.0 * DIG_PI);
    return 0.5 * ((a->force_x_N + b->force_x_N) * (b->pin_X_m - a->pin_X_m) -
                  (a->force_z_N + b->force_z_N) * (b->pin_Z_m - a->pin_Z_m) -
                  (a->moment_Nm + b->moment_Nm) * turned_rad);
}

static double energy_J(const struct digreport_dig_track *const t)
{
    double sum = 0.0;
    for (size_t i = 0; i < t->rows; i++) {
        if (!t->row[i].force_valid) {
            return (double)NAN;
        }
        sum += i > 0 ? work_J(&t->row[i - 1], &t->row[i]) : 0.0;
    }
    return sum;
}

// The moving average about each row, +-half_s; [from, to) moves along.
struct window {
    size_t from, to;
    double sum_Nm;
};

static double smoothed_Nm(const struct digreport_dig_track *const t, struct window *const w,
                          const size_t i)
{
    const int64_t now_ns = t->row[i].time_ns;
    for (; w->to < t->rows && seconds(now_ns, t->row[w->to].time_ns) <= t->half_s; w->to++) {
        w->sum_Nm += t->row[w->to].moment_Nm;
    }
    for (; seconds(t->row[w->from].time_ns, now_ns) > t->half_s; w->from++) {
        w->sum_Nm -= t->row[w->from].moment_Nm;
    }
    return w->sum_Nm / (double)(w->to - w->from);
}

static void score(struct digreport_dig_track *const t)
{
    struct window w      = { 0 };
    double        wrong2 = 0.0;
    double        floor2 = 0.0;
    double        whole2 = 0.0;
    double        peak   = -INFINITY;
    for (size_t i = 0; i < t->rows; i++) {
        const double moment = smoothed_Nm(t, &w, i);
        const double dt     = step_s(t, i);
        double       predicted;
        double       sigma;
        peak = fmax(peak, moment);
        if (t->predicted &&
            dig_predicted_curve_at(&t->prediction, t->row[i].progress, &predicted, &sigma)) {
            wrong2 += dt * (moment - predicted) * (moment - predicted);
            floor2 += dt * sigma * sigma;
            whole2 += dt * moment * moment;
        }
    }
    t->dig.peak_Nm     = peak;
    t->dig.error       = whole2 > 0.0 ? sqrt(wrong2 / whole2) : (double)NAN;
    t->dig.noise_floor = whole2 > 0.0 ? sqrt(floor2 / whole2) : (double)NAN;
}

static void finish_dig(struct digreport_dig_track *const t, struct digreport_dig *const dig)
{
    t->predicted = t->predicted && strcmp(t->prediction.trajectory, t->dig.trajectory) == 0;
    score(t);
    t->dig.energy_J   = energy_J(t);
    t->dig.duration_s = seconds(t->row[0].time_ns, t->row[t->rows - 1].time_ns);
    const struct dig_predicted_curve        none = { .peak_Nm        = (double)NAN,
                                                     .peak_sigma_Nm  = (double)NAN,
                                                     .energy_J       = (double)NAN,
                                                     .energy_sigma_J = (double)NAN };
    const struct dig_predicted_curve *const p    = t->predicted ? &t->prediction : &none;
    t->dig.predicted_peak_Nm                     = p->peak_Nm;
    t->dig.predicted_peak_sigma_Nm               = p->peak_sigma_Nm;
    t->dig.predicted_energy_J                    = p->energy_J;
    t->dig.predicted_energy_sigma_J              = p->energy_sigma_J;
    *dig                                         = t->dig;
}

static enum dig_status add_row(struct digreport_dig_track *const t,
                               const digsight_estimate_t *const  e)
{
    struct digreport_row *const grown = dig_room(t->row, t->rows, sizeof *grown);
    if (grown == NULL) {
        return DIG_ENOMEM;
    }
    t->row            = grown;
    t->row[t->rows++] = (struct digreport_row){
        .time_ns     = e->time_ns,
        .moment_Nm   = e->moment_Nm,
        .progress    = e->progress,
        .force_valid = e->force_valid != 0 && isfinite(e->force_x_N) && isfinite(e->force_z_N) &&
                       isfinite(e->pin_X_m) && isfinite(e->pin_Z_m) && isfinite(e->bucket_phi_rad),
        .force_x_N = e->force_x_N,
        .force_z_N = e->force_z_N,
        .pin_X_m   = e->pin_X_m,
        .pin_Z_m   = e->pin_Z_m,
        .phi_rad   = e->bucket_phi_rad,
    };
    return DIG_OK;
}

enum dig_status digreport_track_estimate(struct digreport_dig_track *const t, const int64_t time_us,
                                         const digsight_estimate_t *const e, bool *const finished,
                                         struct digreport_dig *const dig)
{
    assert(t != NULL && e != NULL && finished != NULL && dig != NULL);
    const bool in_soil = e->phase == DIG_PHASE_CONTACT || e->phase == DIG_PHASE_DIG;
    *finished          = false;
    if (t->open && e->dig_count != t->dig_count) {
        *finished = t->rows > 1;
        if (*finished) {
            finish_dig(t, dig);
        }
        t->open = false;
    } else if (t->open && e->phase == DIG_PHASE_AIR) {
        t->open = false;
    }
    if (!in_soil) {
        return DIG_OK;
    }
    if (!t->open) {
        t->open      = true;
        t->rows      = 0;
        t->predicted = false;
        t->dig_count = e->dig_count;
        t->dig       = (struct digreport_dig){ .time_us = time_us,
                                               .number  = (int32_t)((uint32_t)e->dig_count + 1) };
    }
    if (e->trajectory[0] != '\0' && dig_name_ok(e->trajectory)) {
        (void)snprintf(t->dig.trajectory, sizeof t->dig.trajectory, "%.31s", e->trajectory);
    }
    const bool later = t->rows == 0 || e->time_ns > t->row[t->rows - 1].time_ns;
    return later && e->moment_valid != 0 && fabs(e->moment_Nm) <= DIG_MOMENT_MOST_Nm &&
                   t->rows < ROWS_MAX
               ? add_row(t, e)
               : DIG_OK;
}

void digreport_track_prediction(struct digreport_dig_track *const  t,
                                const digsight_prediction_t *const p)
{
    assert(t != NULL && p != NULL);
    const bool same = t->predicted && strcmp(t->prediction.trajectory, p->trajectory) == 0;
    if (t->open && !same && p->dig_count != t->dig.number &&
        dig_predicted_curve_take(p, &t->prediction)) {
        t->predicted = true;
    }
}

void digreport_track_finish(struct digreport_dig_track *const track)
{
    if (track != NULL) {
        free(track->row);
        *track = (struct digreport_dig_track){ .half_s = track->half_s };
    }
}
