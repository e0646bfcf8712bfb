// The curves of one machine recording: the estimator's wrench, window and resampling, with rates
// that are centred because the whole dig is at hand.

#include "closed_loop/machine_digs/machine_dig.h"
#include "closed_loop/recordings/path_depth.h"
#include "core/entry_set.h"
#include "core/observation.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/track/frame.h"
#include "estimator/track/window.h"
#include "estimator/wrench/wrench.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Of the samples of a dig, so many must tell a channel.
static const double enough_share = 0.9;

// Kept of the air on either side of the dig, machine time.
static const double beside_s = 1.0;

struct reading {
    struct dig_wrench     wrench;
    struct dig_path_point pose;
    bool                  solved;
};

// Every so many of the samples [from, to), read.
struct readings {
    size_t                 from, to, every;
    struct reading        *at;   // [to - from]
    struct dig_path_point *room; // as many points
};

// The sample with the angles and rates of delay_s before, straight between the samples there.
static void put_back(const struct dig_machine_dig *const dig, const size_t at, const double delay_s,
                     struct dig_sample *const sample, struct dig_rates *const rates)
{
    const struct dig_between then = dig_machine_dig_between(dig, dig->time_s[at] - delay_s, at);
    const double             f    = then.fraction;
    const double *const      a    = dig->sample[then.sample].value;
    const double *const      b    = dig->sample[then.sample + 1].value;

    *sample = dig->sample[at];
    *rates  = dig_machine_dig_rates(dig, then);
    for (size_t q = DIG_SIGNAL_BOOM_rad; q <= DIG_SIGNAL_BUCKET_rad; q++) {
        sample->value[q] = (1.0 - f) * a[q] + f * b[q];
    }
}

static bool tells(const struct reading *const r, const bool forces)
{
    return r->solved && r->wrench.moment_valid && (!forces || r->wrench.force_valid);
}

static void solve_all(const struct dig_machine *const     machine,
                      const struct dig_machine_dig *const dig,
                      const struct dig_correction *const correction, const bool with_sigma,
                      const struct dig_curve_set *const set, const struct readings *const all)
{
    struct dig_machine corrected = dig_correction_machine(machine, correction);
    corrected.tolerance          = (struct dig_tolerance){ 0.0, 0.0, 0.0 }; // not asked for here
    for (size_t i = all->from; i < all->to; i += all->every) {
        struct reading    r = { .solved = false };
        struct dig_front  front;
        struct dig_sample sample = dig->sample[i];
        struct dig_rates  rates  = dig->rates[i];
        if (fabs(correction->delay_s) > 0.0) {
            put_back(dig, i, correction->delay_s, &sample, &rates);
        }
        r.solved = dig_wrench_correct(&corrected, correction, &sample, &rates,
                                      DIG_WITH_INERTIA | (with_sigma ? DIG_WITH_SIGMA : 0),
                                      &r.wrench, &front) == DIG_OK;
        if (r.solved) {
            r.pose = dig_machine_dig_point(set, dig, &front);
        }
        all->at[i - all->from] = r;
    }
}

// Where the dig lies by the corrected angles: elsewhere than by those it was found by, where these
// read too much.
static struct dig_track track_of(const struct dig_curve_set *const   set,
                                 const struct dig_machine_dig *const dig,
                                 const struct dig_correction *const  correction,
                                 const struct readings *const        all)
{
    size_t points = 0;
    double turned = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        turned += fabs(correction->angle_rad[j]);
    }
    for (size_t i = all->from; i < all->to && turned > 0.0; i += all->every) {
        if (i >= dig->contact && i < dig->end && all->at[i - all->from].solved) {
            all->room[points++] = all->at[i - all->from].pose;
        }
    }
    return points > 0 ? dig_machine_dig_fit(set, dig, 0, points, all->room) : dig->track;
}

// A reading in rig scale, all channels.
static struct dig_window_sample sample_of(const struct dig_machine_dig *const dig,
                                          const struct reading *const r, const size_t at)
{
    const struct dig_wrench *const w = &r->wrench;

    const double value[DIG_FORCE_CHANNELS]  = { w->My_Nm, w->Fx_N, w->Fz_N };
    const double sigmas[DIG_FORCE_CHANNELS] = { w->sigma_My_Nm, w->sigma_Fx_N, w->sigma_Fz_N };

    struct dig_window_sample sample = { .time_s     = dig->time_s[at] / sqrt(dig->lambda),
                                        .pose       = r->pose,
                                        .has_forces = w->force_valid };
    for (size_t k = 0; k < DIG_FORCE_CHANNELS; k++) {
        const double scale = pow(dig->lambda, k == DIG_CHANNEL_MY_Nm ? 4.0 : 3.0);
        // What does not average down is a share of the whole, told for the moment only.
        const double slow =
            w->sigma_My_Nm > 0.0 ? sigmas[k] * w->slow_sigma_My_Nm / w->sigma_My_Nm : 0.0;
        sample.value[k] = value[k] / scale;
        sample.sigma[k] = (float)(sigmas[k] / scale);
        sample.slow[k]  = (float)(slow / scale);
    }
    dig_frame_turn_forces(dig->frame_rad, &sample);
    return sample;
}

// The samples that tell the moment, or the forces besides, through the estimator's window.
static bool observe(const struct dig_curve_set *const set, const struct dig_machine_dig *const dig,
                    const struct dig_track *const track, const struct readings *const all,
                    const bool forces, struct dig_window *const window,
                    struct dig_observation *const observation)
{
    size_t told = 0;
    size_t of   = 0;
    dig_window_close(window);
    dig_window_open(window);
    window->in_progress = dig->end == dig->samples; // nothing behind its end smooths it
    for (size_t i = all->from; i < all->to; i += all->every) {
        const struct reading *const r      = &all->at[i - all->from];
        const bool                  inside = i >= dig->contact && i < dig->end;
        of += inside ? 1 : 0;
        told += inside && tells(r, forces) ? 1 : 0;
        if (tells(r, forces)) {
            const struct dig_window_sample sample = sample_of(dig, r, i);
            dig_window_add(window, &sample);
        }
    }
    const struct dig_route route = dig_route_make(&set->trajectory[dig->trajectory], set->tooth_m);
    return of > 0 && (double)told >= enough_share * (double)of &&
           dig_window_observe(window, &route, track, 0.18 * set->tooth_m, set->smooth_half_s,
                              observation) == DIG_OK;
}

static void write_channel(const bool is_measured, const double value[DIG_CURVE_POINTS],
                          const double sigma[DIG_CURVE_POINTS], const size_t channel,
                          struct dig_measured *const measured)
{
    measured->measured[channel] = is_measured;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        measured->value[channel][k] = is_measured ? value[k] : 0.0;
        measured->sigma[channel][k] = is_measured ? sigma[k] : 0.0;
    }
}

// By what the window holds, observed along its route.
static void tell_path_depth(const struct dig_curve_set *const   set,
                            const struct dig_machine_dig *const dig,
                            const struct dig_track *const       track,
                            const struct dig_window *const      window,
                            double                              deeper[const DIG_CURVE_POINTS])
{
    const size_t           t     = (size_t)dig->trajectory;
    const struct dig_route route = dig_route_make(&set->trajectory[t], set->tooth_m);
    struct dig_path_depth  depth = { .poses = { 0 } };
    for (size_t i = 0; i < window->count; i++) {
        const double time_s = window->sample[i].time_s * sqrt(dig->lambda);
        if (time_s >= dig->time_s[dig->contact] && time_s < dig->time_s[dig->end - 1]) {
            dig_path_depth_add(&depth, &route, set->tooth_m, track->turn_m / set->tooth_m,
                               window->progress[i], &window->sample[i].pose);
        }
    }
    dig_path_depth_tell(&depth, &route, set->approaches->depth_m[t], deeper);
}

static size_t beside(const struct dig_machine_dig *const dig, const size_t at, const double by_s)
{
    const size_t last = dig->samples - 1;
    return dig_machine_dig_sample_at(dig, dig->time_s[at < last ? at : last] + by_s);
}

enum dig_status dig_machine_dig_measure(const struct dig_machine *const     machine,
                                        const struct dig_curve_set *const   set,
                                        const struct dig_machine_dig *const dig,
                                        const struct dig_correction *const  correction,
                                        const enum dig_measure              how,
                                        struct dig_measured *const          measured)
{
    assert(machine != NULL && set != NULL && dig != NULL && correction != NULL && measured != NULL);
    struct readings          all    = { .from = beside(dig, dig->contact, -beside_s),
                                        .to   = beside(dig, dig->end, beside_s) };
    struct dig_window *const window = calloc(1, sizeof *window);
    const size_t             rows   = all.to > all.from ? all.to - all.from : 0;
    all.every                       = how == DIG_MEASURE_ROUGHLY ? rows / DIG_CURVE_POINTS + 1 : 1;
    all.at                          = malloc((rows + 1) * sizeof *all.at);
    all.room                        = malloc((rows + 1) * sizeof *all.room);
    if (window == NULL || all.at == NULL || all.room == NULL) {
        free(window);
        free(all.at);
        free(all.room);
        return DIG_ENOMEM;
    }
    solve_all(machine, dig, correction, how == DIG_MEASURE_WITH_SIGMA, set, &all);

    const struct dig_track track = track_of(set, dig, correction, &all);
    struct dig_observation o     = { .first = 0.0 };
    const bool             is    = observe(set, dig, &track, &all, true, window, &o) ||
                    observe(set, dig, &track, &all, false, window, &o);
    write_channel(is, o.moment_Nm, o.sigma_Nm, DIG_CHANNEL_MY_Nm, measured);
    for (size_t c = 1; c < DIG_FORCE_CHANNELS; c++) {
        write_channel(is && o.forces, o.force_N[c - 1], o.force_sigma_N[c - 1], c, measured);
    }
    measured->first      = o.first;
    measured->last       = o.last;
    measured->pace       = dig->pace;
    measured->trajectory = dig->trajectory;
    measured->pitch_known =
        dig_machine_dig_pitch(dig, dig->contact, dig->end, &measured->pitch_rad);
    if (is && dig_approach_varies(set, (size_t)dig->trajectory)) {
        tell_path_depth(set, dig, &track, window, measured->deeper);
    }
    free(window);
    free(all.at);
    free(all.room);
    return is ? DIG_OK : DIG_ENOMATCH;
}
