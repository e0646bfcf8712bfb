#include "tests/blind/grid.h"

#include <math.h>
#include <stdlib.h>

// Linear between samples, held at the ends.
static double between(const size_t n, const double t_s[], const double y[], const double at_s)
{
    if (at_s <= t_s[0]) {
        return y[0];
    }
    size_t low  = 0;
    size_t high = n - 1;
    if (at_s >= t_s[high]) {
        return y[high];
    }
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (t_s[middle] <= at_s) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return y[low] + (y[high] - y[low]) * (at_s - t_s[low]) / (t_s[high] - t_s[low]);
}

static enum dig_status sample(const struct dig_trajectory *const trajectory, const double tooth_m,
                              const double pace, const size_t n, const double t_s[],
                              const double y[], struct blind_curve *const curve)
{
    double *const smooth = calloc(n, sizeof *smooth);
    if (smooth == NULL) {
        return DIG_ENOMEM;
    }
    dig_curve_smooth(n, t_s, y, DIG_SMOOTH_HALF_s, smooth);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at =
            dig_trajectory_time_s(trajectory, tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
        curve->y[k] = between(n, t_s, smooth, at / pace);
    }
    free(smooth);
    return DIG_OK;
}

enum dig_status blind_curve_of(const struct dig_trajectory *const trajectory, const double tooth_m,
                               const double pace, const struct dig_recording *const recording,
                               struct blind_curve *const curve)
{
    const size_t    n      = recording->rows;
    double *const   t_s    = calloc(2 * n, sizeof *t_s);
    enum dig_status status = DIG_ENOMEM;
    if (t_s != NULL) {
        for (size_t i = 0; i < n; i++) {
            t_s[i]     = recording->row[i].t_s;
            t_s[n + i] = recording->row[i].My_Nm;
        }
        status = sample(trajectory, tooth_m, pace, n, t_s, t_s + n, curve);
    }
    free(t_s);
    return status;
}

enum dig_status blind_curve_of_samples(const struct dig_trajectory *const trajectory,
                                       const double tooth_m, const double pace, const double step_s,
                                       const size_t n, const double value[],
                                       struct blind_curve *const curve)
{
    double *const t_s = calloc(n, sizeof *t_s);
    if (t_s == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        t_s[i] = (double)i * step_s;
    }
    const enum dig_status status = sample(trajectory, tooth_m, pace, n, t_s, value, curve);
    free(t_s);
    return status;
}

double blind_product(const struct dig_trajectory *const trajectory, const double tooth_m,
                     const struct blind_curve *const a, const struct blind_curve *const b)
{
    double sum  = 0.0;
    double last = 0.0;
    for (int k = 1; k < DIG_CURVE_POINTS; k++) {
        const double t_s =
            dig_trajectory_time_s(trajectory, tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
        sum += 0.5 * (t_s - last) * (a->y[k] * b->y[k] + a->y[k - 1] * b->y[k - 1]);
        last = t_s;
    }
    return sum;
}
