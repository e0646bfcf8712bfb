#include "closed_loop/accuracy/score.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#define GRID_s 0.005

static double at(const double curve[DIG_CURVE_POINTS], const double progress)
{
    const double place = fmin(fmax(progress, 0.0), 1.0) * (DIG_CURVE_POINTS - 1);
    const size_t i     = (size_t)fmin(floor(place), DIG_CURVE_POINTS - 2);
    const double f     = place - (double)i;
    return (1.0 - f) * curve[i] + f * curve[i + 1];
}

void dig_score_add(struct dig_score *const score, const struct dig_trajectory *const trajectory,
                   const double tooth_m, const double first, const double last,
                   const double measured_Nm[DIG_CURVE_POINTS],
                   const double predicted_Nm[DIG_CURVE_POINTS],
                   const double sigma_Nm[DIG_CURVE_POINTS])
{
    assert(score != NULL && trajectory != NULL);

    const double duration_s = dig_trajectory_duration_s(trajectory);
    const double whole_m    = dig_trajectory_path_m(trajectory, tooth_m, duration_s);
    const size_t steps      = (size_t)floor(duration_s / GRID_s);
    for (size_t i = 0; i <= steps; i++) {
        const double progress =
            dig_trajectory_path_m(trajectory, tooth_m, (double)i * GRID_s) / whole_m;
        if (progress < first || progress > last) {
            continue;
        }
        const double measured = at(measured_Nm, progress);
        const double wrong    = measured - at(predicted_Nm, progress);
        const double sigma    = at(sigma_Nm, progress);
        score->wrong_N2m2s += wrong * wrong * GRID_s;
        score->floor_N2m2s += sigma * sigma * GRID_s;
        score->whole_N2m2s += measured * measured * GRID_s;
    }
}

double dig_score_time_s(const struct dig_curve_set *const set, const size_t trajectory,
                        const size_t point)
{
    const struct dig_trajectory *const t    = &set->trajectory[trajectory];
    const double                       last = DIG_CURVE_POINTS - 1;
    const double                       from = fmax((double)point - 0.5, 0.0) / last;
    const double                       to   = fmin((double)point + 0.5, last) / last;
    return dig_trajectory_time_s(t, set->tooth_m, to) -
           dig_trajectory_time_s(t, set->tooth_m, from);
}

double dig_score_error(const struct dig_score *const score)
{
    return score->whole_N2m2s > 0.0 ? sqrt(score->wrong_N2m2s / score->whole_N2m2s) : (double)NAN;
}

double dig_score_noise_floor(const struct dig_score *const score)
{
    return score->whole_N2m2s > 0.0 ? sqrt(score->floor_N2m2s / score->whole_N2m2s) : (double)NAN;
}

void dig_coverage_add(struct dig_coverage *const coverage, const struct dig_observation *const dig,
                      const struct dig_curve *const curve)
{
    assert(coverage != NULL && dig != NULL && curve != NULL);
    for (size_t c = 0; c < (dig->forces ? DIG_FORCE_CHANNELS : 1); c++) {
        const double *const value = c == 0 ? dig->moment_Nm : dig->force_N[c - 1];
        const double *const sigma = c == 0 ? dig->sigma_Nm : dig->force_sigma_N[c - 1];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double at   = (double)k / (DIG_CURVE_POINTS - 1);
            const double band = DIG_COVERAGE_SIGMAS * hypot((double)curve->sd[c][k], sigma[k]);
            if (at >= dig->first && at <= dig->last) {
                coverage->points[c]++;
                coverage->inside[c] += fabs(value[k] - (double)curve->mean[c][k]) <= band ? 1 : 0;
            }
        }
    }
}

double dig_coverage_share(const struct dig_coverage *const coverage, const enum dig_channel channel)
{
    assert(coverage != NULL && (int)channel < DIG_FORCE_CHANNELS);
    return coverage->points[channel] > 0
               ? (double)coverage->inside[channel] / (double)coverage->points[channel]
               : (double)NAN;
}
