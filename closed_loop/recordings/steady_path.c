#include "closed_loop/recordings/steady_path.h"

#include "closed_loop/recordings/alignment.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Of its length: a path that smoothing shortens by less has no noise that matters.
static const double length_share = 0.01;

// Row by row: the three numbers of a pose.
enum { AXES = 3 };

static double *axis_of(struct dig_force_row *const row, const int axis)
{
    double *const of[AXES] = { &row->pin_x_m, &row->pin_z_m, &row->theta_deg };
    return of[axis];
}

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

static void take(const struct dig_recording *const recording, const int axis, double value[])
{
    for (size_t i = 0; i < recording->rows; i++) {
        value[i] = *axis_of(&recording->row[i], axis);
    }
}

static void put(const struct dig_recording *const recording, const int axis, const double value[])
{
    for (size_t i = 0; i < recording->rows; i++) {
        *axis_of(&recording->row[i], axis) = value[i];
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

void dig_steady_average(const size_t readings, const size_t far, double value[], double number[])
{
    assert(readings > 0 && value != NULL && number != NULL);
    for (size_t half = 1; half <= far; half *= 2) {
        smooth(readings, half, value, number);
    }
}

size_t dig_steady_smooth(struct dig_recording *const recording, const double tooth_m,
                         struct dig_force_row room[], double number[])
{
    assert(recording != NULL && recording->rows > 0 && room != NULL && number != NULL);
    const size_t         bytes = recording->rows * sizeof *room;
    struct dig_recording tried = { recording->rows, room };
    double               way_m = dig_alignment_progress(recording, tooth_m, number);
    double               off_m = INFINITY; // the way last smoothed off
    size_t               far   = 0;
    for (size_t half = 1; 4 * half < recording->rows; half *= 2) {
        memcpy(room, recording->row, bytes);
        for (int axis = 0; axis < AXES; axis++) {
            take(&tried, axis, number);
            smooth(recording->rows, half, number, number + recording->rows);
            put(&tried, axis, number);
        }
        const double tried_m = dig_alignment_progress(&tried, tooth_m, number);
        if (way_m - tried_m <= length_share * way_m || way_m - tried_m >= off_m) {
            break;
        }
        memcpy(recording->row, room, bytes);
        off_m = way_m - tried_m;
        way_m = tried_m;
        far   = half;
    }
    return far;
}

void dig_steady_path(struct dig_recording *const recording, const double tooth_m,
                     struct dig_force_row room[], double number[])
{
    assert(recording != NULL && recording->rows > 0 && room != NULL && number != NULL);
    for (int axis = 0; axis < AXES; axis++) {
        take(recording, axis, number);
        dig_steady_readings(recording->rows, 0.0, number);
        put(recording, axis, number);
    }
    (void)dig_steady_smooth(recording, tooth_m, room, number);
}
