#include "estimator/track/steady.h"

#include <assert.h>
#include <math.h>

// Of its length: a path that smoothing shortens by less has no noise that matters.
static const double length_share = 0.01;

// Readings [first, end) of one value.
struct stay {
    size_t first, end;
};

static struct stay stay_from(const size_t readings, const double value[], const size_t first)
{
    struct stay stay = { first, first + 1 };
    while (stay.end < readings && !(fabs(value[stay.end] - value[first]) > 0.0)) {
        stay.end++;
    }
    return stay;
}

// Between two stays that follow each other. Behind their own readings they are not asked again.
static void go_over(const struct stay *const a, const double a_value, const struct stay *const b,
                    const double b_value, double value[])
{
    const size_t shorter =
        a->end - a->first < b->end - b->first ? a->end - a->first : b->end - b->first;
    const double from = (double)a->end - 0.5 - 0.5 * (double)shorter;
    for (size_t i = a->end - shorter / 2; i < a->end + shorter / 2; i++) {
        value[i] = a_value + ((double)i - from) / (double)shorter * (b_value - a_value);
    }
}

void dig_steady_readings(const size_t readings, const double least, double value[])
{
    assert(readings > 0 && value != NULL);
    struct stay a       = stay_from(readings, value, 0);
    double      a_value = value[0];
    while (a.end < readings) {
        const struct stay b       = stay_from(readings, value, a.end);
        const double      b_value = value[b.first];
        if (fabs(b_value - a_value) > least) {
            go_over(&a, a_value, &b, b_value, value);
        }
        a       = b;
        a_value = b_value;
    }
}

// Means over so many readings to either side, as many to both: fewer beside the ends. sum: one more
// than readings.
static void average(const size_t n, const size_t half, double value[], double sum[])
{
    const double about = value[0];
    sum[0]             = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum[i + 1] = sum[i] + value[i] - about;
    }
    for (size_t i = 1; i + 1 < n; i++) {
        const size_t beside = i < n - 1 - i ? i : n - 1 - i;
        const size_t reach  = beside < half ? beside : half;
        value[i] = about + (sum[i + reach + 1] - sum[i - reach]) / (double)(2 * reach + 1);
    }
}

// One time of smoothing. sum: one more than readings.
static void smooth(const size_t readings, const size_t half, double value[], double sum[])
{
    average(readings, half, value, sum);
    average(readings, half, value, sum);
}

void dig_steady_average(const size_t readings, const size_t far, double value[], double sum[])
{
    assert(readings > 0 && value != NULL && sum != NULL);
    for (size_t half = 1; half <= far; half *= 2) {
        smooth(readings, half, value, sum);
    }
}

// Over vertices so far apart, as |pin| + |turn|.
static double length_m(const size_t poses, const struct dig_steady_axis axis[DIG_STEADY_AXES],
                       const double spacing_m)
{
    size_t vertex = 0;
    double way_m  = 0.0;
    for (size_t i = 1; i < poses; i++) {
        double step_m[DIG_STEADY_AXES];
        for (int a = 0; a < DIG_STEADY_AXES; a++) {
            const double *const value = axis[a].value;
            step_m[a] =
                axis[a].scale_m * (value[i * axis[a].stride] - value[vertex * axis[a].stride]);
        }
        const double chord_m = hypot(step_m[0], step_m[1]) + fabs(step_m[2]);
        if (i + 1 == poses || chord_m >= spacing_m) {
            way_m += chord_m;
            vertex = i;
        }
    }
    return way_m;
}

size_t dig_steady_smooth(const size_t poses, const struct dig_steady_axis axis[DIG_STEADY_AXES],
                         const double spacing_m, double *const room[DIG_STEADY_AXES], double sum[])
{
    assert(poses > 0 && axis != NULL && room != NULL && sum != NULL);
    double way_m = length_m(poses, axis, spacing_m);
    double off_m = INFINITY; // the way last smoothed off
    size_t far   = 0;
    for (size_t half = 1; 4 * half < poses; half *= 2) {
        struct dig_steady_axis tried[DIG_STEADY_AXES];
        for (int a = 0; a < DIG_STEADY_AXES; a++) {
            tried[a] = (struct dig_steady_axis){ room[a], 1, axis[a].scale_m };
            for (size_t i = 0; i < poses; i++) {
                room[a][i] = axis[a].value[i * axis[a].stride];
            }
            smooth(poses, half, room[a], sum);
        }
        const double tried_m = length_m(poses, tried, spacing_m);
        if (way_m - tried_m <= length_share * way_m || way_m - tried_m >= off_m) {
            break;
        }
        for (int a = 0; a < DIG_STEADY_AXES; a++) {
            for (size_t i = 0; i < poses; i++) {
                axis[a].value[i * axis[a].stride] = room[a][i];
            }
        }
        off_m = way_m - tried_m;
        way_m = tried_m;
        far   = half;
    }
    return far;
}
