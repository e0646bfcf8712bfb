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

// Rows [first, end) that read one value.
struct stay {
    size_t first, end;
    double value;
};

static struct stay stay_from(const struct dig_recording *const recording, const int axis,
                             const size_t first)
{
    struct stay stay = { first, first + 1, *axis_of(&recording->row[first], axis) };
    while (stay.end < recording->rows &&
           !(fabs(*axis_of(&recording->row[stay.end], axis) - stay.value) > 0.0)) {
        stay.end++;
    }
    return stay;
}

// Between two stays that follow each other. Behind their own rows they are not asked again.
static void go_over(struct dig_recording *const recording, const int axis,
                    const struct stay *const a, const struct stay *const b)
{
    const size_t shorter =
        a->end - a->first < b->end - b->first ? a->end - a->first : b->end - b->first;
    const double from = (double)a->end - 0.5 - 0.5 * (double)shorter;
    for (size_t i = a->end - shorter / 2; i < a->end + shorter / 2; i++) {
        const double along = ((double)i - from) / (double)shorter;

        *axis_of(&recording->row[i], axis) = a->value + along * (b->value - a->value);
    }
}

static void undo_steps(struct dig_recording *const recording, const int axis)
{
    struct stay a = stay_from(recording, axis, 0);
    while (a.end < recording->rows) {
        const struct stay b = stay_from(recording, axis, a.end);
        go_over(recording, axis, &a, &b);
        a = b;
    }
}

// Means over so many rows to either side, as many to both: fewer beside the ends. sum: one more
// than rows.
static void average(const struct dig_recording *const recording, const int axis, const size_t half,
                    double sum[])
{
    const size_t n     = recording->rows;
    const double about = *axis_of(&recording->row[0], axis);
    sum[0]             = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum[i + 1] = sum[i] + *axis_of(&recording->row[i], axis) - about;
    }
    for (size_t i = 1; i + 1 < n; i++) {
        const size_t beside = i < n - 1 - i ? i : n - 1 - i;
        const size_t reach  = beside < half ? beside : half;

        *axis_of(&recording->row[i], axis) =
            about + (sum[i + reach + 1] - sum[i - reach]) / (double)(2 * reach + 1);
    }
}

void dig_steady_path(struct dig_recording *const recording, const double tooth_m,
                     struct dig_force_row room[], double number[])
{
    assert(recording != NULL && recording->rows > 0 && room != NULL && number != NULL);
    for (int axis = 0; axis < AXES; axis++) {
        undo_steps(recording, axis);
    }
    const size_t         bytes = recording->rows * sizeof *room;
    struct dig_recording tried = { recording->rows, room };
    double               way_m = dig_alignment_progress(recording, tooth_m, number);
    double               off_m = INFINITY; // the way last smoothed off
    for (size_t half = 1; 4 * half < recording->rows; half *= 2) {
        memcpy(room, recording->row, bytes);
        for (int axis = 0; axis < AXES; axis++) {
            average(&tried, axis, half, number);
            average(&tried, axis, half, number);
        }
        const double tried_m = dig_alignment_progress(&tried, tooth_m, number);
        if (way_m - tried_m <= length_share * way_m || way_m - tried_m >= off_m) {
            return;
        }
        memcpy(recording->row, room, bytes);
        off_m = way_m - tried_m;
        way_m = tried_m;
    }
}
