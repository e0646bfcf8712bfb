#include "estimator/track/window.h"

#include "estimator/track/ending.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Between two samples the bucket moves less than this share of the route.
#define LOOK 0.10

// Steps forward smaller than this are noise of the angles.
#define STANDING 0.004

// Slot of the next sample once the window is full. Doubling number g drops, of what is there,
// the slots whose bit g - 1 is set; within each residue of the lower bits slots ascend in time, and
// so do the residues. Slots are filled in that order, each dropped one giving way when its turn
// comes.
static size_t next_slot(struct dig_window *const window)
{
    const size_t half = DIG_WINDOW_MAX / 2;
    if (window->stride == 1 || window->replaced == half) {
        window->stride *= 2;
        window->replaced = 0;
    }
    const size_t bit     = window->stride / 2;
    const size_t in_each = half / bit;
    const size_t slot = window->replaced / in_each + bit + 2 * bit * (window->replaced % in_each);
    window->replaced++;
    return slot;
}

void dig_window_add(struct dig_window *const window, const struct dig_window_sample *const sample)
{
    assert(window != NULL && sample != NULL);
    if (!window->open) {
        window->ring[window->before % DIG_WINDOW_BEFORE] = *sample;
        window->before++;
        return;
    }
    if (++window->skipped < window->stride) {
        return;
    }
    window->skipped   = 0;
    const size_t slot = window->count < DIG_WINDOW_MAX ? window->count++ : next_slot(window);

    window->sample[slot] = *sample;
}

void dig_window_open(struct dig_window *const window)
{
    assert(window != NULL && !window->open);
    const size_t have = window->before < DIG_WINDOW_BEFORE ? window->before : DIG_WINDOW_BEFORE;
    for (size_t i = 0; i < have; i++) {
        window->sample[i] = window->ring[(window->before - have + i) % DIG_WINDOW_BEFORE];
    }
    window->open     = true;
    window->count    = have;
    window->stride   = 1;
    window->skipped  = 0;
    window->replaced = 0;
    window->before   = 0;
}

void dig_window_close(struct dig_window *const window)
{
    assert(window != NULL);
    window->open   = false;
    window->count  = 0;
    window->before = 0;
}

static int by_time(const void *const left, const void *const right)
{
    const double a = ((const struct dig_window_sample *)left)->time_s;
    const double b = ((const struct dig_window_sample *)right)->time_s;
    return (a > b) - (a < b);
}

void dig_window_sort(struct dig_window *const window)
{
    assert(window != NULL);
    if (window->stride > 1) {
        qsort(window->sample, window->count, sizeof window->sample[0], by_time);
    }
}

// A range of samples.
struct range {
    size_t first, end;
};

// Furthest progress up to each sample, and the range from the last sample still at the start to the
// first one at the end.
static struct range follow(struct dig_window *const window, const struct dig_route *const route,
                           const struct dig_track *const track, const double limit_m)
{
    struct range range    = { 0, 0 };
    double       last     = 0.0;
    double       furthest = 0.0;
    for (size_t i = 0; i < window->count && furthest < 1.0; i++) {
        const struct dig_path_point at    = dig_track_turned(track, &window->sample[i].pose);
        const struct dig_projection place = dig_route_project(route, track->dx_m, track->dz_m, &at,
                                                              last - LOOK, fmin(last + LOOK, 1.0));
        if (place.distance_m <= limit_m) {
            last     = place.progress;
            furthest = fmax(furthest, place.progress);
        }
        window->progress[i] = furthest;
        range.first         = furthest > 0.0 ? range.first : i;
        range.end           = i + 1;
    }

    // Aborted: after the bucket's last step forward comes the way out.
    while (furthest < 1.0 && range.end > range.first + 1 &&
           window->progress[range.end - 2] > furthest - STANDING) {
        range.end--;
    }
    return range;
}

// When the table's dig was where each sample was. Samples without progress share the way to the
// next step forward: noise of the angles hides steps, and all samples average its noise.
static void place_in_time(struct dig_window *const window, const struct range range,
                          const struct dig_route *const route)
{
    size_t step = range.first;
    for (size_t i = range.first; i < range.end; i++) {
        window->table_s[i] = dig_route_time_s(route, window->progress[i]);
        if (window->progress[i] > window->progress[step]) {
            const double by_s = (window->table_s[i] - window->table_s[step]) / (double)(i - step);
            for (size_t k = step + 1; k < i; k++) {
                window->table_s[k] = window->table_s[step] + by_s * (double)(k - step);
            }
            step = i;
        }
    }
}

// The progress observed: of a dig in progress only as far as samples on both sides smooth it.
static double observed_until(const struct dig_window *const window, const struct range range,
                             const double half_s)
{
    size_t i = range.end - 1;
    if (window->in_progress && window->progress[i] < 1.0) {
        const double until_s = window->table_s[i] - half_s;
        while (i > range.first && window->table_s[i] > until_s) {
            i--;
        }
    }
    return window->progress[i];
}

double dig_window_hole_s(const double half_s)
{
    return fmax(half_s, 0.02);
}

// Whether the range has a hole: a gap longer than the smoothing.
static bool has_hole(const struct dig_window *const window, const struct range range,
                     const double half_s)
{
    const double longest_s = dig_window_hole_s(half_s);
    for (size_t i = range.first + 1; i < range.end; i++) {
        const double step_s = window->sample[i].time_s - window->sample[i - 1].time_s;
        if (step_s > longest_s * (double)window->stride) {
            return true;
        }
    }
    return false;
}

// Where a point of the grid was first reached: between a sample and the next.
struct spot {
    bool   measured;
    size_t sample;
    double share; // of the next
};

static size_t find_spots(const struct dig_window *const window, const struct range range,
                         const double first, const double last, struct spot spot[])
{
    size_t i      = range.first;
    size_t points = 0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        spot[k]         = (struct spot){ .measured = false };
        if (at < first || at > last) {
            continue;
        }
        while (i + 2 < range.end && window->progress[i + 1] < at) {
            i++;
        }
        const double span = window->progress[i + 1] - window->progress[i];
        const double f = span > 0.0 ? fmin(fmax((at - window->progress[i]) / span, 0.0), 1.0) : 0.0;
        spot[k]        = (struct spot){ true, i, f };
        points++;
    }
    return points;
}

// A sample's sigma after smoothing: white noise averages, the slow part does not.
static double smoothed_sigma(const struct dig_window *const window, const struct range range,
                             const size_t i, const double half_s, const size_t channel)
{
    const double sigma  = (double)window->sample[i].sigma[channel];
    const double slow   = (double)window->sample[i].slow[channel];
    const double white2 = fmax(sigma * sigma - slow * slow, 0.0);
    const double left =
        white2 > 0.0 ? dig_curve_noise_left(range.end - range.first, &window->table_s[range.first],
                                            i - range.first, half_s)
                     : 0.0;
    return sqrt(slow * slow + left * white2);
}

// Smooths window->value, a channel's, and evaluates it at the grid's spots; 0 where there is none.
static void smooth_at(struct dig_window *const window, const struct range range,
                      const double half_s, const struct spot spot[], double out[DIG_CURVE_POINTS])
{
    dig_curve_smooth(range.end - range.first, &window->table_s[range.first],
                     &window->value[range.first], half_s, &window->smooth[range.first]);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const size_t i = spot[k].sample;
        out[k]         = spot[k].measured ? window->smooth[i] +
                                        spot[k].share * (window->smooth[i + 1] - window->smooth[i])
                                          : 0.0;
    }
}

// What friction of a drive adds to a channel: the error is smoothed as the channel is.
static void read_rubs(struct dig_window *const window, const struct range range,
                      const double half_s, const struct spot spot[], const size_t drive,
                      const size_t channel, float out[DIG_CURVE_POINTS])
{
    double rubs[DIG_CURVE_POINTS];
    for (size_t i = range.first; i < range.end; i++) {
        window->value[i] = (double)window->sample[i].rubs[drive][channel];
    }
    smooth_at(window, range, half_s, spot, rubs);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        out[k] = (float)rubs[k];
    }
}

// Smooths a channel and evaluates it and its sigma at the grid.
static void read_channel(struct dig_window *const window, const struct range range,
                         const double half_s, const struct spot spot[], const size_t channel,
                         struct dig_observation *const to)
{
    const bool    moment = channel == DIG_CHANNEL_MY_Nm;
    double *const out    = moment ? to->moment_Nm : to->force_N[channel - 1];
    double *const sigma  = moment ? to->sigma_Nm : to->force_sigma_N[channel - 1];
    for (size_t j = 0; j < DIG_RUBS; j++) {
        read_rubs(window, range, half_s, spot, j, channel, to->rubs[j][channel]);
    }
    for (size_t i = range.first; i < range.end; i++) {
        window->value[i] = window->sample[i].value[channel];
    }
    smooth_at(window, range, half_s, spot, out);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sigma[k] =
            spot[k].measured ? smoothed_sigma(window, range, spot[k].sample, half_s, channel) : 0.0;
        for (size_t j = 0; j < DIG_RUBS; j++) {
            sigma[k] = hypot(sigma[k], (double)to->rubs[j][channel][k]);
        }
    }
}

static bool has_forces(const struct dig_window *const window, const struct range range)
{
    bool has = true;
    for (size_t i = range.first; i < range.end; i++) {
        has = has && window->sample[i].has_forces;
    }
    return has;
}

enum dig_status dig_window_observe(struct dig_window *const      window,
                                   const struct dig_route *const route,
                                   const struct dig_track *const track, const double limit_m,
                                   const double half_s, struct dig_observation *const observation)
{
    assert(window != NULL && route != NULL && track != NULL && observation != NULL);
    dig_window_sort(window);
    const struct range range = follow(window, route, track, limit_m);
    if (range.end < range.first + 3 || has_hole(window, range, half_s)) {
        return DIG_ENOMATCH;
    }
    place_in_time(window, range, route);
    const double first = window->progress[range.first];
    const double last  = observed_until(window, range, half_s);
    struct spot  spot[DIG_CURVE_POINTS];
    if (find_spots(window, range, first, last, spot) < 2) {
        return DIG_ENOMATCH;
    }
    observation->forces = has_forces(window, range);
    for (size_t c = 0; c < (observation->forces ? DIG_FORCE_CHANNELS : 1); c++) {
        read_channel(window, range, half_s, spot, c, observation);
    }
    const struct dig_path_point *const left = &window->sample[window->count - 1].pose;

    observation->ending     = window->in_progress
                                  ? DIG_ENDING_OPEN
                                  : dig_ending_of(route, track, last, left, 0.5 * limit_m);
    observation->first      = first;
    observation->last       = last;
    observation->off_path_m = track->rms_m;
    return DIG_OK;
}
